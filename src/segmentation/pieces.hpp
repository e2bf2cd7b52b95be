#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "segmentation/components.hpp"

namespace gfp {

/// Per-pixel normals inside the clusters (whatever memory holds elsewhere: do not look) and the piece of every pixel.
struct PieceMap {
  std::unique_ptr<float[]> nx, ny, nz;
  std::vector<std::int32_t> piece;  ///< -1: none.
  std::vector<PixelList> pixels;    ///< Of each piece, ascending.
  std::vector<int> cluster;         ///< Which cluster each piece is part of.
  Eigen::Vector3f normal(std::int32_t i) const {
    const auto k = static_cast<std::size_t>(i);
    return {nx[k], ny[k], nz[k]};
  }
};

/// Cuts clusters where two surfaces meet in a concave crease, or where one ends in a step of depth in front of another.
/// Pieces are what remains connected; the pixels of the cuts go back to the nearest piece. Smooth and convex shapes stay whole.
PieceMap cut_into_pieces(const OrganizedCloud& cloud, const std::vector<PixelList>& clusters, double tolerance_m);

}  // namespace gfp
