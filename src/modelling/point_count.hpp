#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

namespace gfp {

/// How many scene points lie within a fixed radius of a place: the contour's external field (P24).
using PointCount = std::function<int(const Eigen::Vector3f&)>;

/// By PCL's kd-tree, as in the paper.
PointCount count_by_kd_tree(std::span<const Eigen::Vector3f> points, float radius_m);

/// By our voxel grid: the same counts.
PointCount count_by_voxel_grid(std::span<const Eigen::Vector3f> points, float radius_m);

}  // namespace gfp
