#pragma once

#include <optional>
#include <vector>

#include "gfp/grasp/plan_grasps.hpp"
#include "grasp/gripper_boxes.hpp"
#include "grasp/triangle_bvh.hpp"

namespace gfp {

/// What the gripper must not touch beside the object: table, neighbours' meshes, obstacle points. Camera frame.
/// Neighbours get their hierarchy when a box first comes near them. One thread at a time.
class Surroundings {
 public:
  /// Keeps only what lies within `reach_m` of `centre`.
  Surroundings(const GraspScene& scene, const Eigen::Vector3d& centre, double reach_m);

  /// Whether the gripper comes nearer than `clearance_m` (in box coordinates; never misses one that is nearer than that).
  bool blocks(const GripperBoxes& boxes, double clearance_m);
  /// Exact least distance of the gripper's closing and palm boxes, at most `limit_m`; 0 on contact.
  double distance(const GripperBoxes& boxes, double limit_m);
  /// Of a point above the table; 1e300 without one.
  double height(const Eigen::Vector3d& point) const { return has_support_ ? up_.dot(point) - support_offset_ : 1e300; }
  /// Table only: whether a box reaches below it.
  bool below_support(const GripperBoxes& boxes, double clearance_m) const;

 private:
  struct Neighbour {
    TriangleMesh mesh_camera;
    Eigen::Vector3d centre, extent;
    std::optional<TriangleBvh> bvh;
  };
  TriangleBvh& hierarchy(Neighbour& neighbour);
  double lowest(const OrientedBox& box) const;

  bool has_support_ = false;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();
  double support_offset_ = 0;
  std::vector<Neighbour> neighbours_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace gfp
