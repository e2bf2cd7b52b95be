#pragma once

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/segmentation/segments.hpp"
#include "segmentation/supports.hpp"

namespace gfp {

/// The rectangle that holds every reading: outside it a sensor sees nothing at all.
PixelRect readings_rect(const OrganizedCloud& cloud, const std::vector<std::uint8_t>& valid);

/// Whether a pixel is among the outermost ones with readings (many sensors leave one or two more blind at times).
inline bool at_border(const PixelRect& readings, int u, int v) {
  constexpr int kBorderPx = 2;
  return u < readings.u0 + kBorderPx || v < readings.v0 + kBorderPx || u >= readings.u1 - kBorderPx || v >= readings.v1 - kBorderPx;
}

/// Fills bbox, touches_border, occluded, top_cut and height_m from the pixels, the labels of all segments (index, negative
/// for none) and the support (null where unknown: height is then the extent along the camera's y).
void describe_outline(const OrganizedCloud& cloud, const Image<std::int32_t>& labels, const PixelRect& readings,
                      const FlatSurface* support, Segment& segment);

}  // namespace gfp
