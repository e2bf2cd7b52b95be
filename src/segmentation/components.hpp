#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"

namespace gfp {

/// Depths of an image or of a part of one, row-major.
struct DepthGrid {
  const float* z = nullptr;
  int width = 0, height = 0;
  double focal_px = 0;
};

inline DepthGrid depth_grid(const OrganizedCloud& cloud) { return {cloud.z.data(), cloud.width, cloud.height, std::max(cloud.camera.fx, cloud.camera.fy)}; }

struct ComponentOptions {
  double tolerance_m = 0.010;      ///< Largest step in depth between neighbours, at 1 m and nearer; grows with z^2 beyond.
  double bridged_gap_m = 0.010;    ///< Pixels without a reading are crossed as far as this.
};

/// Pixels of one component, row-major indices, ascending.
using PixelList = std::vector<std::int32_t>;

/// `pixels` is not empty.
PixelRect bounding_box(const PixelList& pixels, int width);

/// Connected components of the pixels whose class is not 0; only pixels of one class are joined. Neighbours in the image are
/// joined where their depths differ by less than the tolerance, and likewise across a few pixels without a reading (`valid` 0).
/// Components smaller than `min_pixels` are left out; the others come in the order of their first pixel.
/// Runs of a row and union-find with path halving: linear in the pixels.
std::vector<PixelList> connected_components(const DepthGrid& depth, const std::vector<std::uint8_t>& classes,
                                            const std::vector<std::uint8_t>& valid, const ComponentOptions& options, int min_pixels);

}  // namespace gfp
