#include "grasp/surroundings.hpp"

#include <algorithm>

namespace gfp {

Surroundings::Surroundings(const GraspScene& scene, const Eigen::Vector3d& centre, double reach_m) {
  has_support_ = scene.has_support;
  up_ = scene.T_camera_support.linear().col(2);
  support_offset_ = up_.dot(scene.T_camera_support.translation());
  for (const FittedModel* model : scene.neighbours) {
    Neighbour neighbour{model->mesh_camera(), {}, {}, {}};
    const Bounds box = bounds(neighbour.mesh_camera.vertices);
    neighbour.centre = box.centre();
    neighbour.extent = 0.5 * box.size();
    const double gap = ((neighbour.centre - centre).cwiseAbs() - neighbour.extent).cwiseMax(0.0).norm();
    if (gap < reach_m) neighbours_.push_back(std::move(neighbour));
  }
  for (const Eigen::Vector3f& point : scene.obstacle_points_camera) {
    const Eigen::Vector3d p = point.cast<double>();
    if ((p - centre).squaredNorm() < reach_m * reach_m) points_.push_back(p);  // false for NaN
  }
}

TriangleBvh& Surroundings::hierarchy(Neighbour& neighbour) {
  if (!neighbour.bvh) neighbour.bvh.emplace(neighbour.mesh_camera.vertices, neighbour.mesh_camera.triangles);
  return *neighbour.bvh;
}

double Surroundings::lowest(const OrientedBox& box) const {
  const Eigen::Vector3d centre = box.T_box_world.inverse().translation();
  return up_.dot(centre) - (box.T_box_world.linear() * up_).cwiseAbs().dot(box.half) - support_offset_;
}

bool Surroundings::below_support(const GripperBoxes& boxes, double clearance_m) const {
  return has_support_ && (lowest(boxes.closing) < clearance_m || lowest(boxes.palm) < clearance_m);
}

bool Surroundings::blocks(const GripperBoxes& boxes, double clearance_m) {
  if (below_support(boxes, clearance_m)) return true;
  for (const OrientedBox& box : {boxes.closing.grown(clearance_m), boxes.palm.grown(clearance_m)}) {
    for (Neighbour& neighbour : neighbours_)
      if (bounds_box_distance(neighbour.centre, neighbour.extent, box) == 0 && hierarchy(neighbour).meets(box)) return true;
    for (const Eigen::Vector3d& point : points_)
      if (((box.T_box_world * point).cwiseAbs() - box.half).maxCoeff() <= 0) return true;
  }
  return false;
}

double Surroundings::distance(const GripperBoxes& boxes, double limit_m) {
  double least = limit_m;
  for (const OrientedBox& box : {boxes.closing, boxes.palm}) {
    if (has_support_) least = std::min(least, std::max(0.0, lowest(box)));
    for (Neighbour& neighbour : neighbours_)
      if (bounds_box_distance(neighbour.centre, neighbour.extent, box) < least) least = hierarchy(neighbour).distance(box, least);
    for (const Eigen::Vector3d& point : points_) least = std::min(least, point_box_distance(point, box));
  }
  return least;
}

}  // namespace gfp
