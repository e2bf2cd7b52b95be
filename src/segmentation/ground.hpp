#pragma once

#include <vector>

#include "segmentation/flat_regions.hpp"

namespace gfp {

/// How far a surface lies above its plane, cell by cell: real tables are warped by more than a sensor's noise, and sensors
/// bend flat ones. Cells that do not belong to the surface continue their neighbours' value.
struct Ground {
  int cell_px = 1;              ///< Side of a cell; cell (c, r) is centred on pixel ((c + 0.5) cell_px, (r + 0.5) cell_px).
  int columns = 0, rows = 0;
  std::vector<float> offset_m;  ///< Along the plane's normal.

  /// Bilinear at one pixel.
  float at(int u, int v) const;

  /// The same along one row of the image: fills `row` (width pixels).
  void interpolate_row(int v, int width, float* row) const;
};

Ground ground_of(const CellGrid& grid, const FlatRegion& surface, int cell_px);

}  // namespace gfp
