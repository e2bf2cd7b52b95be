#pragma once

#include <cstdint>
#include <functional>

#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// Two pictures of one instant, as a stereo camera delivers them: same size, not rectified.
struct StereoPair {
  Image<std::uint8_t> left, right;
  Image<Rgb8> color;  ///< The left picture in colour; empty where the camera has none.
};

/// Fills depth, colour, camera and noise of a frame from a pair. What a stereo driver is given, since it knows no matcher.
/// Called for several pairs at a time. Errors: kCorruptFrame (the pair's size is not the calibration's).
using StereoToFrame = std::function<Result<void>(const StereoPair& pair, Frame& frame)>;

}  // namespace gfp
