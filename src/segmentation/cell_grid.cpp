#include "segmentation/cell_grid.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

namespace gfp {
namespace {

constexpr float kMinDepth = 0.05F, kMaxDepth = 30.0F;  // metres: what any of our sensors could mean
constexpr int kMinCellReadings = 12;                   // of 16

Cell fit_cell(const SampleGrid& grid, int i0, int j0) {
  Cell cell;
  for (int j = j0; j < j0 + kCellSamples; ++j)
    for (int i = i0; i < i0 + kCellSamples; ++i)
      if (const auto s = grid.index(i, j); grid.valid(s)) cell.sums.add(grid.ray_x[s], grid.ray_y[s], grid.inverse_depth[s]);
  if (cell.sums.n < kMinCellReadings) return cell;
  if (const auto fit = cell.sums.solve()) {
    cell.fit = *fit;
    cell.flat = fit->rms_inverse_m <= flatness_tolerance(cell.mean_inverse());
  }
  return cell;
}

}  // namespace

SampleGrid sample_grid(const OrganizedCloud& cloud) {
  SampleGrid grid;
  grid.stride = std::clamp(std::min(cloud.width, cloud.height) / 120, 1, 128);
  grid.width = (cloud.width - grid.stride / 2 + grid.stride - 1) / grid.stride;
  grid.height = (cloud.height - grid.stride / 2 + grid.stride - 1) / grid.stride;
  const auto count = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  for (auto* plane : {&grid.ray_x, &grid.ray_y, &grid.inverse_depth}) plane->assign(count, 0.0F);
  oneapi::tbb::parallel_for(0, grid.height, [&](int j) {
    for (int i = 0; i < grid.width; ++i) {
      const auto at = static_cast<std::size_t>(j * grid.stride + grid.stride / 2) * static_cast<std::size_t>(cloud.width) +
                      static_cast<std::size_t>(i * grid.stride + grid.stride / 2);
      if (!(cloud.z[at] >= kMinDepth && cloud.z[at] <= kMaxDepth)) continue;
      const float inverse = 1.0F / cloud.z[at];
      const auto s = grid.index(i, j);
      grid.ray_x[s] = cloud.x[at] * inverse;
      grid.ray_y[s] = cloud.y[at] * inverse;
      grid.inverse_depth[s] = inverse;
    }
  });
  return grid;
}

CellGrid fit_cells(const SampleGrid& grid) {
  CellGrid cells{grid.width / kCellSamples, grid.height / kCellSamples, {}};
  cells.cells.resize(static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows));
  oneapi::tbb::parallel_for(0, cells.rows, [&](int r) {
    for (int c = 0; c < cells.columns; ++c) cells.cells[static_cast<std::size_t>(r * cells.columns + c)] = fit_cell(grid, c * kCellSamples, r * kCellSamples);
  });
  return cells;
}

}  // namespace gfp
