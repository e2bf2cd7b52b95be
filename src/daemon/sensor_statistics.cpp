#include "daemon/sensor_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

/// Nearest rank: the smallest value that at least a share q of the values does not exceed. `values` are sorted.
double quantile(const std::vector<double>& values, double q) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

void SensorStatistics::frame_arrived() {
  MutexLock lock(mutex_);
  ++frames_;
  ++frames_in_window_;
}

void SensorStatistics::scene_done(Nanoseconds latency) {
  MutexLock lock(mutex_);
  ++scenes_in_window_;
  if (latencies_ms_.size() < kMaxLatencies) latencies_ms_.push_back(std::chrono::duration<double, std::milli>(latency).count());
}

void SensorStatistics::turn(Nanoseconds now) {
  MutexLock lock(mutex_);
  const double seconds = std::max(1e-9, std::chrono::duration<double>(now - turned_).count());
  std::sort(latencies_ms_.begin(), latencies_ms_.end());
  rates_.fps = static_cast<double>(frames_in_window_) / seconds;
  rates_.scenes_fps = static_cast<double>(scenes_in_window_) / seconds;
  rates_.latency_p50_ms = quantile(latencies_ms_, 0.50);
  rates_.latency_p99_ms = quantile(latencies_ms_, 0.99);
  frames_in_window_ = scenes_in_window_ = 0;
  latencies_ms_.clear();
  turned_ = now;
}

SensorStatistics::Rates SensorStatistics::rates() const {
  MutexLock lock(mutex_);
  Rates rates = rates_;
  rates.frames = frames_;
  return rates;
}

}  // namespace gfp
