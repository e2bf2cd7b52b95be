#pragma once

#include <cstdint>
#include <vector>

#include "gfp/segmentation/segment_cloud.hpp"
#include "segmentation/supports.hpp"

namespace gfp {

/// What a pixel is to the supports. Values from kOnSupport on are kOnSupport + k, from kAbove on kAbove + k (support k).
enum PixelClass : std::uint8_t { kInvalidPixel = 0, kElsewhere = 1, kWall = 2, kOnSupport = 16, kAbove = 32 };

/// One class per pixel. A pixel above several supports belongs to the highest of them. Cost: about 0.1 ms a surface.
std::vector<std::uint8_t> classify_pixels(const OrganizedCloud& cloud, const Supports& supports, const SegmentationOptions& options);

}  // namespace gfp
