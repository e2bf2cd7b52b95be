#include "gfp/frame/clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace gfp {
namespace {

constexpr Nanoseconds kSecond = std::chrono::seconds(1);
constexpr std::size_t kPoints = 600;
constexpr Nanoseconds kSpanForDrift = std::chrono::seconds(10);  // over less, jitter of a millisecond looks like 100 ppm
constexpr double kMaxDrift = 500e-6;                             // no quartz is worse
constexpr Nanoseconds kStep = std::chrono::milliseconds(500);    // the clocks part by this from one frame to the next: one was set
constexpr Nanoseconds kStandstill = std::chrono::microseconds(1);
constexpr std::uint64_t kFramesToLock = 5;

double seconds(Nanoseconds time) { return 1e-9 * static_cast<double>(time.count()); }

}  // namespace

void ClockFit::restart() {
  points_.clear();
  previous_.reset();
  slope_ = 0;
  frames_ = 0;
  state_ = "free";
}

Nanoseconds ClockFit::to_host(Nanoseconds device, Nanoseconds arrival) {
  const Point point{device, arrival - device};
  if (previous_ && stepped(point)) {
    points_.clear();
    slope_ = 0;
    stepped_at_ = arrival;
    state_ = "stepped";
  }
  previous_ = point;
  ++frames_;
  if (state_ == "free" && frames_ >= kFramesToLock) state_ = "locked";
  if (state_ == "stepped" && arrival - stepped_at_ > kSecond) state_ = "locked";
  add(point);
  last_ = std::max(last_ + Nanoseconds(1), std::min(arrival, device + lag_at(device)));
  return last_;
}

/// Frames may be late by any time; neither that nor drift makes the device's time leap ahead of the host's, go back or stand still.
bool ClockFit::stepped(const Point& point) const {
  const Nanoseconds device_step = point.device - previous_->device, host_step = device_step + point.lag - previous_->lag;
  return device_step <= kStandstill || device_step - host_step > kStep;
}

void ClockFit::add(const Point& point) {
  const bool new_second = points_.empty() || point.device / kSecond != points_.back().device / kSecond;
  if (!new_second && point.lag >= points_.back().lag) return;
  if (new_second) points_.push_back(point);
  else points_.back() = point;
  if (points_.size() > kPoints) points_.pop_front();
  fit();
}

/// The lower hull's edge over the middle of the points: of the lines below all of them, the one with the least sum of distances.
void ClockFit::fit() {
  const auto lowest = std::min_element(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.lag < b.lag; });
  anchor_ = *lowest;
  slope_ = 0;
  if (points_.back().device - points_.front().device < kSpanForDrift) return;
  const auto rise = [](const Point& a, const Point& b) { return seconds(b.lag - a.lag) / seconds(b.device - a.device); };
  std::vector<Point> hull;
  for (const Point& point : points_) {
    while (hull.size() >= 2 && rise(hull[hull.size() - 2], hull.back()) >= rise(hull.back(), point)) hull.pop_back();
    hull.push_back(point);
  }
  double middle_s = 0;
  for (const Point& point : points_) middle_s += seconds(point.device - points_.front().device) / static_cast<double>(points_.size());
  std::size_t edge = 0;
  while (edge + 2 < hull.size() && seconds(hull[edge + 1].device - points_.front().device) < middle_s) ++edge;
  slope_ = std::clamp(rise(hull[edge], hull[edge + 1]), -kMaxDrift, kMaxDrift);
  anchor_ = hull[edge];
  for (const Point& point : points_)  // where the slope was clamped, the line is moved below all points again
    if (point.lag < lag_at(point.device)) anchor_ = point;
}

Nanoseconds ClockFit::lag_at(Nanoseconds device) const { return anchor_.lag + Nanoseconds(std::llround(slope_ * static_cast<double>((device - anchor_.device).count()))); }

}  // namespace gfp
