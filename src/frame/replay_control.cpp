#include "gfp/frame/replay_control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gfp {

void ReplayControl::pause() {
  MutexLock lock(mutex_);
  state_.paused = true;
  steps_ = 0;
}

void ReplayControl::resume() {
  MutexLock lock(mutex_);
  state_.paused = false;
  changed_.notify_all();
}

void ReplayControl::step() {
  MutexLock lock(mutex_);
  ++steps_;
  changed_.notify_all();
}

void ReplayControl::set_speed(double speed) {
  MutexLock lock(mutex_);
  if (std::isfinite(speed)) state_.speed = std::max(0.0, speed);
}

void ReplayControl::seek(Nanoseconds position) {
  MutexLock lock(mutex_);
  seek_ = std::clamp(position, Nanoseconds(0), state_.duration);
  state_.position = *seek_;
  state_.ended = false;
  if (state_.paused) ++steps_;  // a person who seeks wants to see where
  changed_.notify_all();
}

ReplayControl::State ReplayControl::state() const {
  MutexLock lock(mutex_);
  return state_;
}

void ReplayControl::hold_at_end() {
  MutexLock lock(mutex_);
  holds_at_end_ = true;
}

bool ReplayControl::holds_at_end() const {
  MutexLock lock(mutex_);
  return holds_at_end_;
}

void ReplayControl::begin(Nanoseconds recorded_at, Nanoseconds duration, double speed) {
  MutexLock lock(mutex_);
  state_.begin = recorded_at;
  state_.duration = duration;
  state_.speed = speed;
}

void ReplayControl::played(Nanoseconds position, bool ended) {
  MutexLock lock(mutex_);
  state_.position = position;
  state_.ended = ended;
  if (!ended) ++state_.frames;
}

std::optional<Nanoseconds> ReplayControl::take_seek() {
  MutexLock lock(mutex_);
  return std::exchange(seek_, std::nullopt);
}

bool ReplayControl::wait_until_running(std::chrono::milliseconds timeout) {
  MutexLock lock(mutex_);
  const auto may_run = [this]() GFP_REQUIRES(mutex_) { return !state_.paused || steps_ > 0; };
  if (!changed_.wait_for(lock, timeout, may_run)) return false;
  if (state_.paused) --steps_;
  return true;
}

bool ReplayControl::wait_for_seek(std::chrono::milliseconds timeout) {
  MutexLock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this]() GFP_REQUIRES(mutex_) { return seek_.has_value(); });
}

}  // namespace gfp
