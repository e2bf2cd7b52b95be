#include "modelling/point_count.hpp"

#include <memory>

#include "gfp/core/voxel_grid.hpp"

namespace gfp {

PointCount count_by_voxel_grid(std::span<const Eigen::Vector3f> points, float radius_m) {
  const auto grid = std::make_shared<const VoxelGrid>(points, 2 * radius_m);  // shared: std::function copies what it holds
  return [grid, radius_m](const Eigen::Vector3f& place) { return grid->count_within(place, radius_m); };
}

}  // namespace gfp
