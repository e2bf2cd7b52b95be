#include "collection/extract_border.hpp"

#include <algorithm>
#include <array>

#include "gfp/core/isosurface.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr float kLevel = 0.29F;  ///< Of the blurred body: a flat sheet one voxel thick has 1/3 in its middle.
constexpr int kPad = 2;

ScalarGrid occupancy(const VoxelSolid& solid) {
  int first = 1 << 30, last = -(1 << 30);
  for (const auto& run : solid.runs) {
    first = std::min(first, run.first);
    last = std::max(last, run.last);
  }
  const Vector3i low(first - kPad, solid.low.y() - kPad, solid.low.z() - kPad);
  ScalarGrid grid(solid.voxel_m * (low.cast<double>() + Vector3d::Constant(0.5)), solid.voxel_m,
                  Vector3i(last - first + 2 * kPad, solid.size.y() + 2 * kPad, solid.size.z() + 2 * kPad));
  for (int k = 0; k < solid.size.z(); ++k)
    for (int j = 0; j < solid.size.y(); ++j) {
      const auto row = static_cast<std::size_t>(k * solid.size.y() + j);
      for (auto r = solid.offsets[row]; r < solid.offsets[row + 1]; ++r) {
        const auto& run = solid.runs[static_cast<std::size_t>(r)];
        std::fill_n(&grid.values[grid.index(run.first - low.x(), j + kPad, k + kPad)], run.last - run.first, 1.0F);
      }
    }
  return grid;
}

/// The mean of three neighbours along every axis.
void blur(ScalarGrid& grid) {
  const std::array<std::size_t, 3> steps{1, static_cast<std::size_t>(grid.size.x()), static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y())};
  std::vector<float> before;
  for (const std::size_t step : steps) {
    before = grid.values;
    for (std::size_t at = step; at + step < before.size(); ++at) grid.values[at] = (before[at - step] + before[at] + before[at + step]) * (1.0F / 3.0F);
  }
}

}  // namespace

TriangleMesh extract_border(const VoxelSolid& solid) {
  if (solid.runs.empty()) return {};
  ScalarGrid grid = occupancy(solid);
  blur(grid);
  return largest_component(isosurface(grid, kLevel));
}

}  // namespace gfp
