#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "bumblebee/decode_stereo.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

/// One complete transfer of a camera, copied out of its library's buffer.
struct Transfer {
  std::vector<std::uint8_t> bytes;
  std::uint64_t number = 0;  ///< Of the camera's pictures since it was opened, lost ones and ones that were left out counted.
  int width = 0, height = 0, bytes_per_pixel = 1;
  Nanoseconds device{};    ///< Camera's clock, or the bus driver's.
  Nanoseconds arrival{};   ///< Of its first packet, host CLOCK_MONOTONIC.

  RawPicture picture() const { return {width, height, bytes_per_pixel, bytes}; }
};

/// A camera that streams until its end. One thread at a time.
class CameraLink {
 public:
  virtual ~CameraLink() = default;
  /// The oldest picture that waits; where more wait than a short pause explains, the newest. Errors: kTimeout, kCorruptFrame (packets are missing),
  /// kDeviceLost (the camera is gone).
  virtual Result<Transfer> next(std::chrono::milliseconds timeout) = 0;
};

/// A camera that answers on the network or the bus.
struct LinkedCamera {
  std::string id, model, serial;
};

}  // namespace gfp
