#include "daemon/frame_inbox.hpp"

#include <algorithm>

namespace gfp {

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
  changed_.wait(lock, stop, [this]() GFP_REQUIRES(mutex_) { return !waiting_.empty(); });
  if (stop.stop_requested()) return std::nullopt;
  const auto first = std::min_element(waiting_.begin(), waiting_.end(),
                                      [](const auto& a, const auto& b) { return a.second->stamps.monotonic < b.second->stamps.monotonic; });
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
