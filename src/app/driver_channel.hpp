#pragma once

#include <cstdint>

#include "gfp/core/error.hpp"

namespace gfp {

/// What a driver's process is given as open descriptors: behind standard error.
inline constexpr int kChannelDescriptor = 3, kRingDescriptor = 4, kConfigDescriptor = 5;

/// What it says over the channel, a packet each: it lives, and what became of its source.
struct DriverMessage {
  enum Kind : std::uint32_t { kOpened = 1, kOpenFailed, kFrame, kError };
  std::uint32_t kind = 0;
  std::uint32_t code = 0;   ///< ErrorCode of kOpenFailed and kError.
  std::uint64_t turn = 0;   ///< In the ring, of kFrame.
  char text[496] = {};      ///< Error::what, ends in 0.
};

/// A timeout of the driver's own grabs: so often at least it shows that it lives.
inline constexpr int kDriverBeat_ms = 100;

/// Body of `gfpd --driver-child`: opens the source of the first sensor in the configuration (YAML, in kConfigDescriptor) and writes its frames into the ring
/// until the channel closes, the device is lost or the stream ends. Dies with its parent. Returns the exit code.
int run_driver_child();

}  // namespace gfp
