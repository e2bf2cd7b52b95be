#pragma once

#include <chrono>
#include <cstdint>

namespace gfp {

using Nanoseconds = std::chrono::nanoseconds;

/// The three times of a frame. Stages never read a clock; whoever makes a frame fills these.
struct Stamps {
  Nanoseconds sensor{};     ///< Device clock, unwrapped; strictly increasing within a session.
  Nanoseconds monotonic{};  ///< Host CLOCK_MONOTONIC at arrival; latencies are measured against it.
  Nanoseconds realtime{};   ///< Host CLOCK_REALTIME at arrival; for people and logs only.
};

/// Reads CLOCK_MONOTONIC and CLOCK_REALTIME. For drivers, the daemon and tools only.
Nanoseconds monotonic_now();
Nanoseconds realtime_now();

}  // namespace gfp
