#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <stop_token>
#include <string>

#include "gfp/core/mutex.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/frame/latest_slot.hpp"

namespace gfp {

/// Where the frames of all sensors wait for the one pipeline: a place of one frame a sensor. Safe from any thread.
class FrameInbox {
 public:
  explicit FrameInbox(HandOver policy) : policy_(policy) {}

  /// kLossless: from now on a frame is taken only when all who are expected have one waiting, so that frames come in the order of their sensors' stamps
  /// however fast each of them is. Until finished().
  void expect(const std::string& sensor);
  void finished(const std::string& sensor);

  /// kLatestWins: replaces the sensor's frame that was not taken yet, and counts it. kLossless: waits until it was taken.
  void put(FramePtr frame, const std::stop_token& stop);

  /// Blocks for the frame that arrived first; kLossless: that has the earliest stamp of its sensor. Empty: stop was requested.
  std::optional<FramePtr> take(const std::stop_token& stop);

  std::uint64_t dropped(const std::string& sensor) const;

 private:
  const HandOver policy_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::set<std::string> expected_ GFP_GUARDED_BY(mutex_);
  std::map<std::string, FramePtr> waiting_ GFP_GUARDED_BY(mutex_);
  std::map<std::string, std::uint64_t> dropped_ GFP_GUARDED_BY(mutex_);
};

}  // namespace gfp
