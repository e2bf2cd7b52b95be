#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <optional>
#include <string>
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
/// What an earlier run left open is closed before the first file. put(), trigger() and status() are safe from any thread.
class Recorder {
 public:
  using ScenePtr = std::shared_ptr<const Scene>;

  Recorder(RecordingOptions options, HandOver policy, std::unique_ptr<RecordingStorage> storage = disk_storage());
  ~Recorder();  ///< Writes what waits and closes the file.

  void put(FramePtr frame) { push(std::move(frame)); }
  void put(ScenePtr scene) { push(std::move(scene)); }
  void trigger();  ///< Of a ring: what it holds becomes a file.

  struct Status {
    std::string mode;           ///< Now: as configured, or as start() and stop() have left it.
    RecordingStatus recording;  ///< Counts are of all files; `file` is the last one, where none is being written.
    std::uint64_t dropped = 0;  ///< Frames and scenes that the recorder came too late for.
  };
  Status status() const;

  enum class Action { kStatus, kStart, kStop, kTrigger };
  /// From now on everything goes into a file; the file is closed, and a ring goes on filling; trigger(). Returns when it is done, with the
  /// status after it. One thread at a time. Errors: kInvalidArgument (a trigger where no ring is filled), kTimeout (the disk takes too long).
  Result<Status> control(Action action);

 private:
  using Item = std::variant<FramePtr, ScenePtr>;
  static constexpr std::size_t kMaxWaiting = 32;

  void launch();
  void change_mode(const std::string& mode);
  void push(Item item);
  void run(const std::stop_token& stop);
  void record(const std::deque<Item>& items);
  void report();

  static constexpr std::chrono::seconds kPatience{10};

  const std::string configured_mode_;
  const HandOver policy_;
  const std::unique_ptr<RecordingStorage> storage_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Item> waiting_ GFP_GUARDED_BY(mutex_);
  bool triggered_ GFP_GUARDED_BY(mutex_) = false, ended_ GFP_GUARDED_BY(mutex_) = false;
  std::uint64_t asked_ GFP_GUARDED_BY(mutex_) = 0, done_ GFP_GUARDED_BY(mutex_) = 0;  ///< Actions, counted.
  std::optional<std::string> next_mode_ GFP_GUARDED_BY(mutex_);
  Status status_ GFP_GUARDED_BY(mutex_);
  std::atomic<bool> is_on_;  ///< Somebody wants what is put.
  // From here on: the recorder thread's own.
  RecordingOptions options_;
  std::unique_ptr<RecordingSeries> series_;
  std::unique_ptr<class RecordingClock> clock_;
  RecordingStatus reported_, before_;  ///< Last reported; of the series before this one.
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
