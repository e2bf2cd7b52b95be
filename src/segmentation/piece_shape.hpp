#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "segmentation/pieces.hpp"
#include "segmentation/supports.hpp"

namespace gfp {

/// What the assembly needs to know of a piece; those of two pieces add up to those of their union.
struct PieceShape {
  int pixels = 0;
  double base_m = 1e9, top_m = -1e9;   ///< 5 % and 99 % quantile of the height above the support (of a union: the outermost).
  int foot = 0, foot_hidden = 0;       ///< Pixels of the lower outline; those below which something nearer, or the image's end, may hide more.
  int open = 0;                        ///< Steps out of its outline, across both axes, after which the next reading belongs to no piece.
  double normals = 0;                  ///< Count of the sums below.
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  double normal_dot_point = 0, squared_distance = 0;

  void add(const PieceShape& other);
  Eigen::Vector3d mean_point() const { return point / std::max(1.0, normals); }
  Eigen::Vector3d mean_normal() const { return normal / std::max(1.0, normals); }
  /// Root mean square distance of its points from their mean, metres.
  double spread_m() const { return std::sqrt(std::max(0.0, squared_distance / std::max(1.0, normals) - mean_point().squaredNorm())); }
  /// Mean of (n - mean n) . (p - mean p), metres: positive where the surface is convex as a whole, negative where it is hollow.
  double bulge_m() const { return normal_dot_point / std::max(1.0, normals) - mean_normal().dot(mean_point()); }
};

PieceShape piece_shape(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid, int piece,
                       const FlatSurface* support, double tolerance_m);

}  // namespace gfp
