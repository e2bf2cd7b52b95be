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
  Eigen::Vector3d point;    ///< Camera frame, metres.
  Eigen::Vector3d normal;   ///< Inward (into the object), unit, camera frame.
  bool observed = false;
};

/// One way to take hold of an object, camera frame.
struct Grasp {
  Transform T_camera_tcp = Transform::Identity();
  Transform T_camera_parent = Transform::Identity();
  Transform T_camera_pregrasp_tcp = Transform::Identity();  ///< Where the straight approach starts.
  std::string gripper;
  double width_m = 0;                 ///< Opening at the grasp: distance of the contacts.
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();      ///< Unit, camera frame.
  double epsilon = 0;                 ///< Ferrari-Canny, L1, exact; torque scaled by the bounding radius.
  double volume_quality = 0;          ///< Volume of the grasp wrench space.
  bool force_closure = false;
  double p_force_closure = 0;         ///< Under the shape's uncertainty.
  double epsilon_lcb = 0;             ///< 10 % quantile of epsilon under the shape's uncertainty.
  std::array<GraspContact, 2> contacts;
  double collision_margin_m = 0;      ///< Least distance of the gripper's boxes to table and neighbours; >= 0.
  std::string visibility;             ///< `both`, `one` or `none` of the contacts were seen.
  bool abstain = false;               ///< Too uncertain to execute.
  double score = 0;                   ///< What the list is ordered by.
};

/// Why an object has no grasp; empty where it has one: `too_wide`, `no_antipodal_pair`, `all_in_collision`,
/// `not_force_closure`, `unreachable`, `not_planned`.
struct GraspPlan {
  std::vector<Grasp> grasps;  ///< Best first.
  std::string no_grasp_reason;
};

}  // namespace gfp
