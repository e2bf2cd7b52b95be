#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "segmentation/inverse_depth_fit.hpp"

namespace gfp {

/// Every `stride`-th pixel of every `stride`-th row as ray and inverse depth; inverse depth 0 where there is no reading.
struct SampleGrid {
  int stride = 1, width = 0, height = 0;
  std::vector<float> ray_x, ray_y, inverse_depth;
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i); }
  bool valid(std::size_t s) const { return inverse_depth[s] > 0; }
  Eigen::Vector3d point(std::size_t s) const { return Eigen::Vector3d(ray_x[s], ray_y[s], 1.0) / inverse_depth[s]; }
};

/// About 120 samples on the shorter side.
SampleGrid sample_grid(const OrganizedCloud& cloud);

inline constexpr int kCellSamples = 4;  ///< A cell is 4 x 4 samples: 16 x 16 pixels of a 640 x 480 image.

/// A plane fitted to one cell.
struct Cell {
  InverseDepthSums sums;
  PlaneFit fit;
  bool flat = false;  ///< Enough readings, and no rougher than a sensor's noise explains.
  double mean_inverse() const { return sums.w / sums.n; }
  /// How far the cell's middle lies off a plane, as a residual of 1/z.
  double offset_from(const PlaneFit& plane) const { return plane.residual(sums.x / sums.n, sums.y / sums.n, mean_inverse()); }
};

struct CellGrid {
  int columns = 0, rows = 0;
  std::vector<Cell> cells;
  const Cell& operator[](int c) const { return cells[static_cast<std::size_t>(c)]; }
  /// Calls `visit` with the index of each 4-neighbour of cell `c`.
  template <class Visit>
  void neighbours(int c, Visit&& visit) const {
    const int column = c % columns, row = c / columns;
    if (column > 0) visit(c - 1);
    if (column + 1 < columns) visit(c + 1);
    if (row > 0) visit(c - columns);
    if (row + 1 < rows) visit(c + columns);
  }
};

CellGrid fit_cells(const SampleGrid& grid);

/// What noise and unevenness may put between a reading and its plane, as a residual of 1/z: 3 mm + 4 mm z^2 in depth.
inline double flatness_tolerance(double inverse_depth) { return 0.003 * inverse_depth * inverse_depth + 0.004; }

}  // namespace gfp
