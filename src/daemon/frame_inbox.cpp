#include "daemon/frame_inbox.hpp"

#include <algorithm>

namespace gfp {

void FrameInbox::expect(const std::string& sensor) {
  MutexLock lock(mutex_);
  if (policy_ == HandOver::kLossless) expected_.insert(sensor);
}

void FrameInbox::finished(const std::string& sensor) {
  MutexLock lock(mutex_);
  expected_.erase(sensor);
  changed_.notify_all();
}

void FrameInbox::put(FramePtr frame, const std::stop_token& stop) {
  MutexLock lock(mutex_);
  const std::string sensor = frame->sensor;
  if (policy_ == HandOver::kLossless)
    changed_.wait(lock, stop, [&]() GFP_REQUIRES(mutex_) { return !waiting_.contains(sensor); });
  if (stop.stop_requested()) return;
  const auto [place, is_free] = waiting_.insert_or_assign(sensor, std::move(frame));
  if (!is_free) ++dropped_[sensor];
  changed_.notify_all();
}

std::optional<FramePtr> FrameInbox::take(const std::stop_token& stop) {
  MutexLock lock(mutex_);
  const auto all_have_one = [this]() GFP_REQUIRES(mutex_) {
    return !waiting_.empty() && std::all_of(expected_.begin(), expected_.end(), [this](const std::string& sensor) GFP_REQUIRES(mutex_) { return waiting_.contains(sensor); });
  };
  changed_.wait(lock, stop, all_have_one);
  if (stop.stop_requested()) return std::nullopt;
  const auto time = [this](const auto& entry) { return policy_ == HandOver::kLossless ? entry.second->stamps.sensor : entry.second->stamps.monotonic; };
  const auto first = std::min_element(waiting_.begin(), waiting_.end(), [&](const auto& a, const auto& b) { return time(a) < time(b); });
  FramePtr frame = std::move(first->second);
  waiting_.erase(first);
  changed_.notify_all();
  return frame;
}

std::uint64_t FrameInbox::dropped(const std::string& sensor) const {
  MutexLock lock(mutex_);
  const auto found = dropped_.find(sensor);
  return found == dropped_.end() ? 0 : found->second;
}

}  // namespace gfp
