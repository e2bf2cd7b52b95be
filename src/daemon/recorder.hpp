#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <thread>
#include <variant>

#include "gfp/core/mutex.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/frame/latest_slot.hpp"
#include "gfp/recording/recording_series.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// Records what the daemon sees and publishes: one thread owns the files. What streams never waits for a disk.
///
///     sensors, pipeline --put()--> queue of kMaxWaiting (the oldest is dropped and counted; lossless: put() waits)
///                              --recorder thread--> RecordingMessages --> RecordingSeries --> files
///
/// What an earlier run left open is closed first. put(), trigger() and status() are safe from any thread.
class Recorder {
 public:
  using ScenePtr = std::shared_ptr<const Scene>;

  Recorder(RecordingOptions options, HandOver policy, std::unique_ptr<RecordingStorage> storage = disk_storage());
  ~Recorder();  ///< Writes what waits and closes the file.

  void put(FramePtr frame) { push(std::move(frame)); }
  void put(ScenePtr scene) { push(std::move(scene)); }
  void trigger();  ///< Of a ring: what it holds becomes a file.

  struct Status {
    RecordingStatus recording;
    std::uint64_t dropped = 0;  ///< Frames and scenes that the recorder came too late for.
  };
  Status status() const;

 private:
  using Item = std::variant<FramePtr, ScenePtr>;
  static constexpr std::size_t kMaxWaiting = 32;

  void push(Item item);
  void run(const std::stop_token& stop);
  void record(const std::deque<Item>& items);
  void report();

  const RecordingOptions options_;
  const HandOver policy_;
  const std::unique_ptr<RecordingStorage> storage_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Item> waiting_ GFP_GUARDED_BY(mutex_);
  bool triggered_ GFP_GUARDED_BY(mutex_) = false, ended_ GFP_GUARDED_BY(mutex_) = false;
  Status status_ GFP_GUARDED_BY(mutex_);
  // From here on: the recorder thread's own.
  std::unique_ptr<RecordingSeries> series_;
  std::unique_ptr<class RecordingClock> clock_;
  RecordingStatus reported_;
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
