#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "gfp/core/transform.hpp"

namespace gfp {

/// A parallel jaw with soft fingers, as data. Tool-centre frame (tcp): origin midway between the finger tips, x along the
/// approach (towards the object), y along the closing axis, z completes the right-handed frame.
struct Gripper {
  std::string name = "parallel_85";
  double stroke_m = 0.085;            ///< Widest opening between the pads.
  double min_width_m = 0.0;
  double finger_length_m = 0.045;     ///< From palm to tip, along the approach.
  double finger_width_m = 0.020;      ///< Across, along tcp z.
  double finger_thickness_m = 0.010;  ///< Along the closing axis, outside the pad.
  double pad_depth_m = 0.012;         ///< How far behind the tips contacts should lie.
  double palm_width_m = 0.14;         ///< Palm box along the closing axis.
  double palm_height_m = 0.07;        ///< Along tcp z.
  double palm_depth_m = 0.06;         ///< Behind the fingers.
  double friction = 0.5;              ///< Coulomb coefficient of pad on object.
  double torsion_m = 0.005;           ///< Soft finger: torsional moment = friction * force * torsion_m (effective pad radius).
  Transform T_tcp_parent = Transform::Identity();  ///< Pose of the robot's parent link (flange) in the tcp frame.
};

template <class Visitor>
void visit_fields(Gripper& o, Visitor&& field) {
  field("name", o.name);
  field("stroke_m", o.stroke_m, 0.001, 1.0);
  field("min_width_m", o.min_width_m, 0.0, 1.0);
  field("finger_length_m", o.finger_length_m, 0.001, 0.5);
  field("finger_width_m", o.finger_width_m, 0.001, 0.2);
  field("finger_thickness_m", o.finger_thickness_m, 0.0005, 0.2);
  field("pad_depth_m", o.pad_depth_m, 0.0, 0.5);
  field("palm_width_m", o.palm_width_m, 0.001, 1.0);
  field("palm_height_m", o.palm_height_m, 0.001, 1.0);
  field("palm_depth_m", o.palm_depth_m, 0.001, 1.0);
  field("friction", o.friction, 0.01, 5.0);
  field("torsion_m", o.torsion_m, 0.0001, 0.1);
  field("T_tcp_parent", o.T_tcp_parent);
}

struct GraspContact {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< Camera frame, metres.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Inward (into the object), unit, camera frame.
  bool observed = false;
};

/// One way to take hold of an object, camera frame.
struct Grasp {
  Transform T_camera_tcp = Transform::Identity();
  Transform T_camera_parent = Transform::Identity();
  Transform T_camera_pregrasp_tcp = Transform::Identity();  ///< Where the straight approach starts.
  std::string gripper;
  double width_m = 0;                 ///< Opening at the grasp: distance of the contacts along the closing axis.
  double opening_m = 0;               ///< Opening during the approach: width and clearance on both sides, at most the stroke.
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();      ///< Unit, camera frame.
  double epsilon = 0;                 ///< Ferrari-Canny, L1, exact; torque scaled by the bounding radius.
  double volume_quality = 0;          ///< Volume of the grasp wrench space.
  bool force_closure = false;
  double p_force_closure = 0;         ///< Under the shape's uncertainty.
  double epsilon_lcb = 0;             ///< 10 % quantile of epsilon under the shape's uncertainty.
  std::array<GraspContact, 2> contacts;  ///< The pad at +y of the tcp frame first.
  /// Least distance of the gripper's boxes (the fingers with the gap they close through, the palm), over the whole straight
  /// approach, to table, neighbours and obstacle points; >= 0, at most 0.2.
  double collision_margin_m = 0;
  std::string visibility;             ///< `both`, `one` or `none` of the contacts were seen.
  Eigen::Vector3d helpful_view = Eigen::Vector3d::UnitZ();  ///< Unit, camera frame: looking along it shows the less certain contact head-on.
  bool abstain = false;               ///< Too uncertain to execute: p_force_closure below PlanGraspsOptions::abstain_below_p.
  double score = 0;                   ///< What the list is ordered by.
};

/// Why an object has no grasp; empty where it has one:
/// - `not_planned`: no grasps were asked for (or the work was shed);
/// - `too_wide`: a gripper of wider stroke would hold it, or all pairs of contacts that oppose each other are farther apart
///   than the stroke less the clearance;
/// - `no_antipodal_pair`: no two points oppose each other inside the friction cones;
/// - `all_in_collision`: the gripper meets the object, the table or a neighbour in every pose;
/// - `unreachable`: there are free poses, but something stands in every straight approach to them;
/// - `not_force_closure`: in every free pose the closed pads hold with less than the least epsilon.
struct GraspPlan {
  std::vector<Grasp> grasps;  ///< Best first.
  std::string no_grasp_reason;
  int poses_examined = 0;     ///< Jaw poses looked at, all on antipodal contacts inside the stroke.
};

/// The plan of an object that moved, and everything around it with it. `T_now_before`: camera frame.
GraspPlan moved(GraspPlan plan, const Transform& T_now_before);

}  // namespace gfp
