#pragma once

#include <cstdint>
#include <vector>

#include "gfp/core/mutex.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

/// How fast a sensor's frames arrive and become scenes. Times are given, never read. Safe from any thread.
class SensorStatistics {
 public:
  struct Rates {
    double fps = 0, scenes_fps = 0;
    double latency_p50_ms = 0, latency_p99_ms = 0;  ///< Of the scenes since the last turn; 0 where there were none.
    std::uint64_t frames = 0;                       ///< Since the beginning.
  };

  explicit SensorStatistics(Nanoseconds now) : turned_(now) {}

  void frame_arrived();
  void scene_done(Nanoseconds latency);
  /// Ends the window that began with the last turn and starts a new one.
  void turn(Nanoseconds now);
  Rates rates() const;  ///< Of the window that ended last.

 private:
  static constexpr std::size_t kMaxLatencies = 4096;

  mutable Mutex mutex_;
  Nanoseconds turned_ GFP_GUARDED_BY(mutex_);
  std::uint64_t frames_ GFP_GUARDED_BY(mutex_) = 0, frames_in_window_ GFP_GUARDED_BY(mutex_) = 0, scenes_in_window_ GFP_GUARDED_BY(mutex_) = 0;
  std::vector<double> latencies_ms_ GFP_GUARDED_BY(mutex_);
  Rates rates_ GFP_GUARDED_BY(mutex_);
};

}  // namespace gfp
