#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace gfp {

/// A plane normal . p + offset = 0 with the points near it.
struct PlaneInliers {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset_m = 0;
  std::vector<std::int32_t> inliers;  ///< Indices of points, ascending; empty where there is no plane.
};

/// PCL's RANSAC plane, refitted to its inliers. The same points give the same plane: its random numbers have a fixed seed.
PlaneInliers ransac_plane(const std::vector<Eigen::Vector3f>& points, double inlier_m);

/// PCL's Euclidean cluster extraction, the largest cluster first; indices of points, ascending.
std::vector<std::vector<std::int32_t>> euclidean_clusters(const std::vector<Eigen::Vector3f>& points, double tolerance_m, int min_points);

}  // namespace gfp
