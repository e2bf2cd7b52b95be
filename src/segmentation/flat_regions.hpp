#pragma once

#include <vector>

#include "segmentation/cell_grid.hpp"

namespace gfp {

/// A flat part of the scene, of any orientation: cells that continue each other's plane.
struct FlatRegion {
  PlaneFit fit;            ///< To all its samples.
  InverseDepthSums sums;
  std::vector<int> cells;  ///< Ascending.
};

/// Grown breadth first from the smoothest cells; deterministic (no random draws, ties by index). At least six cells; the largest first.
std::vector<FlatRegion> flat_regions(const CellGrid& grid);

/// The flat cells that lie on a known plane, wherever they are; empty where they are fewer than six.
FlatRegion region_on_plane(const CellGrid& grid, const PlaneFit& plane);

/// Joins regions that are one surface: neighbours that meet without a step at less than 12 deg (a warped or bent table is
/// several flat regions), and pieces of one plane that something divides. The largest first.
std::vector<FlatRegion> join_surfaces(const CellGrid& grid, std::vector<FlatRegion> regions);

}  // namespace gfp
