#pragma once

#include <chrono>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// What a source is, as data; nobody asks "is this a Kinect?".
struct SourceInfo {
  std::string driver;        ///< replay, synthetic, openni2...
  std::string model;
  std::string serial;
  double rate_hz = 0;        ///< 0 where unknown.
  double min_depth_m = 0;
  double max_depth_m = 0;
  bool finite = false;       ///< A recording that ends: grab() then says kEndOfStream.
  bool may_repeat = false;   ///< Frames may equal each other without anything being stuck: a loop, a sensor without noise.
};

/// The driver interface; everything above it is written once. One thread at a time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual SourceInfo info() const = 0;
  virtual Result<void> open() = 0;  ///< May be called again after kDeviceLost.
  /// Errors: kTimeout, kCorruptFrame (the next may be fine), kDeviceLost, kEndOfStream.
  virtual Result<Frame> grab(std::chrono::milliseconds timeout) = 0;
  virtual void close() noexcept = 0;  ///< Idempotent.
};

}  // namespace gfp
