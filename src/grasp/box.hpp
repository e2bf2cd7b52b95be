#pragma once

#include <Eigen/Core>

#include "gfp/core/mesh.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {

/// A box anywhere in a world: |T_box_world p| <= half, component by component. Metres.
struct OrientedBox {
  Transform T_box_world = Transform::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();

  /// From bounds in the coordinates of `T_world_frame`.
  static OrientedBox of(const Bounds& bounds_frame, const Transform& T_world_frame) {
    OrientedBox box;
    box.T_box_world = Eigen::Translation3d(-bounds_frame.centre()) * T_world_frame.inverse();
    box.half = 0.5 * bounds_frame.size();
    return box;
  }
  OrientedBox grown(double by_m) const { return {T_box_world, half.array() + by_m}; }
};

/// Whether triangle and box share a point (separating axes, Akenine-Moller 2001). Box coordinates.
bool triangle_meets_box(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& half);

/// Exact distance, 0 where they meet. Box coordinates.
double triangle_box_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& half);

/// Exact distance of the axis-aligned box `centre` +- `extent` (world) to the box's own bounding box in box coordinates: a
/// lower bound of the distance of what is inside, 0 where they may meet.
double bounds_box_distance(const Eigen::Vector3d& centre, const Eigen::Vector3d& extent, const OrientedBox& box);

/// Distance of a point to the box, 0 inside.
double point_box_distance(const Eigen::Vector3d& point_world, const OrientedBox& box);

}  // namespace gfp
