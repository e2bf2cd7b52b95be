#pragma once

#include <cstdint>
#include <filesystem>

#include "gfp/core/image.hpp"

namespace gfp::bench {

/// OpenCV's StereoSGBM in its mode 3WAY, on one thread, with the parameters of OpenCV's own samples (block 3, P1 = 8 b^2, P2 = 32 b^2,
/// uniqueness 10, speckles below 100 pixels).
class OpencvStereo {
 public:
  OpencvStereo(int min_disparity_px, int disparities);
  /// Disparity in sixteenths of a pixel; below 16 min_disparity_px where there is no match.
  Image<std::int16_t> match(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right) const;

 private:
  int min_disparity_px_, disparities_;
};

/// The picture in grey, averaged down to this size.
Image<std::uint8_t> read_scaled(const std::filesystem::path& file, int width, int height);

}  // namespace gfp::bench
