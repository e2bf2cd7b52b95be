#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <thread>

#include "config/daemon_options.hpp"
#include "daemon/frame_inbox.hpp"
#include "daemon/recorder.hpp"
#include "daemon/sensor_statistics.hpp"
#include "gfp/frame/run_source.hpp"
#include "publish/publisher.hpp"

namespace gfp {

/// A source of which others can see that a grab does not return.
class WatchedSource final : public FrameSource {
 public:
  explicit WatchedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}
  SourceInfo info() const override { return source_->info(); }
  Result<void> open() override { return source_->open(); }
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override { source_->close(); }
  bool hangs() const;  ///< A grab is over its timeout by half a second. Safe from any thread.

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  const std::unique_ptr<FrameSource> source_;
  std::atomic<std::int64_t> due_ns_{kNever};
};

/// One sensor at work: a thread that runs its driver, and one that hands its frames on.
///
///     source --driver thread--> LatestSlot --relay thread--> publisher (sensor topics), inbox (pipeline)
class SensorWorker {
 public:
  /// Starts at once. `publisher`, `inbox` and `recorder` (nullptr: none) must live longer.
  SensorWorker(SensorConfig config, std::unique_ptr<FrameSource> source, HandOver policy, FrameInbox& inbox, Publisher& publisher,
               Recorder* recorder = nullptr);
  ~SensorWorker();

  const SensorConfig& config() const { return config_; }
  SensorStatistics& statistics() { return statistics_; }

  void request_stop();  ///< Does not wait; the destructor does.
  v1::SensorStatus status() const;  ///< Safe from any thread.

 private:
  void drive(const std::stop_token& stop);
  void relay(const std::stop_token& stop);
  void changed(const SourceStatus& status);

  const SensorConfig config_;
  WatchedSource source_;
  const SourceInfo info_;
  FrameInbox& inbox_;
  Publisher& publisher_;
  Recorder* const recorder_;
  SensorStatistics statistics_;
  LatestSlot<FramePtr> slot_;
  mutable Mutex mutex_;
  SourceStatus source_status_ GFP_GUARDED_BY(mutex_);
  std::jthread relay_, driver_;  ///< Last: they use all of the above.
};

}  // namespace gfp
