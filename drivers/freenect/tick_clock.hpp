#pragma once

#include <cstdint>

#include "gfp/core/time.hpp"

namespace gfp {

/// A Kinect's 32-bit clock of 60 MHz, which wraps every 71.6 s, as time that only goes forward. A step back of less than half the
/// range is no wrap but a restarted or disturbed device: time then stands almost still. One thread at a time.
class TickClock {
 public:
  /// Nanoseconds since the first call, strictly rising.
  Nanoseconds unwrap(std::uint32_t ticks) {
    if (!started_) last_ticks_ = ticks;
    const std::uint32_t forward = ticks - last_ticks_;  // modulo 2^32
    if (forward < 0x80000000U) elapsed_ticks_ += forward;
    last_ticks_ = ticks;
    // 50 / 3 ns a tick; seconds apart, so that nothing overflows in a robot's life.
    const auto whole = static_cast<std::int64_t>(elapsed_ticks_ / kRate_hz), part = static_cast<std::int64_t>(elapsed_ticks_ % kRate_hz);
    const Nanoseconds now(whole * 1'000'000'000 + part * 50 / 3);
    last_ = started_ && now <= last_ ? last_ + Nanoseconds(1) : now;
    started_ = true;
    return last_;
  }

 private:
  static constexpr std::uint64_t kRate_hz = 60'000'000;
  bool started_ = false;
  std::uint32_t last_ticks_ = 0;
  std::uint64_t elapsed_ticks_ = 0;
  Nanoseconds last_{};
};

}  // namespace gfp
