#pragma once

#include <deque>
#include <optional>
#include <string_view>

#include "gfp/core/time.hpp"

namespace gfp {

/// A device's clock in terms of the host's CLOCK_MONOTONIC, so that the frames of several devices can be ordered.
///
/// A frame arrives some time after it was taken, never before: of the points (device time, host arrival) the fitted line lies below all and as near to them as
/// it can (Zhang, Liu and Xia, Clock synchronization algorithms for network measurements, 2002: an edge of their lower hull). Late frames do not move it. What
/// stays in the stamps is the device's shortest delay. One thread at a time; reads no clock.
class ClockFit {
 public:
  /// When a frame was taken, host time: not later than `arrival`, strictly rising. `device`: its stamp by the device's clock, which may drift and step.
  Nanoseconds to_host(Nanoseconds device, Nanoseconds arrival);
  /// `free` (too few frames yet), `locked`, or `stepped` (the device's clock jumped, went back or stood still within the last second).
  std::string_view state() const { return state_; }
  double drift_ppm() const { return 1e6 * slope_; }  ///< By which the device's clock is slow.
  void restart();  ///< Another device time; the stamps go on rising.

 private:
  struct Point {
    Nanoseconds device, lag;  ///< lag: arrival minus device.
  };
  void add(const Point& point);
  void fit();
  Nanoseconds lag_at(Nanoseconds device) const;
  bool stepped(const Point& point) const;

  std::deque<Point> points_;        ///< The least lag of each second of the last ten minutes.
  std::optional<Point> previous_;
  Point anchor_{};                  ///< The line goes through it,
  double slope_ = 0;                ///< with this rise of lag.
  Nanoseconds last_{-1};
  Nanoseconds stepped_at_{};        ///< Arrival.
  std::uint64_t frames_ = 0;
  std::string_view state_ = "free";
};

}  // namespace gfp
