#include "daemon/recorder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "gfp/core/time.hpp"
#include "wire/recorded_messages.hpp"

namespace gfp {

/// The messages' log times: the host's clock, which may be set back, while a recording's time only goes forward.
class RecordingClock {
 public:
  explicit RecordingClock(const RecordContent& content) : messages(content) {}
  Nanoseconds next() { return last_ = std::max(realtime_now(), last_ + Nanoseconds(1)); }
  wire::RecordingMessages messages;

 private:
  Nanoseconds last_{};
};

namespace {

const char* name_of(RecordingStatus::State state) {
  switch (state) {
    case RecordingStatus::State::kIdle: return "idle";
    case RecordingStatus::State::kRecording: return "recording";
    case RecordingStatus::State::kNoSpace: return "out of space";
    case RecordingStatus::State::kFailing: return "failing";
  }
  return "unknown";
}

}  // namespace

Recorder::Recorder(RecordingOptions options, HandOver policy, std::unique_ptr<RecordingStorage> storage)
    : options_(std::move(options)),
      policy_(policy),
      storage_(std::move(storage)),
      series_(std::make_unique<RecordingSeries>(options_, *storage_)),
      clock_(std::make_unique<RecordingClock>(options_.content)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Recorder::~Recorder() = default;

void Recorder::push(Item item) {
  MutexLock lock(mutex_);
  if (policy_ == HandOver::kLossless) changed_.wait(lock, [this]() GFP_REQUIRES(mutex_) { return waiting_.size() < kMaxWaiting || ended_; });
  if (waiting_.size() >= kMaxWaiting) {
    waiting_.pop_front();
    ++status_.dropped;
  }
  waiting_.push_back(std::move(item));
  changed_.notify_all();
}

void Recorder::trigger() {
  MutexLock lock(mutex_);
  triggered_ = true;
  changed_.notify_all();
}

Recorder::Status Recorder::status() const {
  MutexLock lock(mutex_);
  return status_;
}

void Recorder::run(const std::stop_token& stop) {
  for (const Recovered& file : recover_recordings(options_.folder, options_.prefix))
    spdlog::log(file.is_whole ? spdlog::level::info : spdlog::level::warn, "recording {} of an earlier run: {}", file.file.string(), file.what);
  bool stopped = false;
  while (!stopped) {
    std::deque<Item> items;
    bool triggered = false;
    {
      MutexLock lock(mutex_);
      changed_.wait_for(lock, stop, std::chrono::milliseconds(50), [this]() GFP_REQUIRES(mutex_) { return !waiting_.empty() || triggered_; });
      items.swap(waiting_);
      triggered = std::exchange(triggered_, false);
      stopped = stop.stop_requested();
      ended_ = stopped;
      changed_.notify_all();
    }
    record(items);
    if (triggered) series_->trigger(monotonic_now());
    series_->tick(monotonic_now());
    report();
  }
  series_->close();
  report();
}

void Recorder::record(const std::deque<Item>& items) {
  const auto sink = [this](const McapChannelSpec& spec, const McapMessage& message) { series_->put(spec, message, monotonic_now()); };
  for (const Item& item : items) {
    const Nanoseconds log_time = clock_->next();
    std::visit([&](const auto& value) { clock_->messages.put(*value, log_time, sink); }, item);
  }
}

/// A line per change of state or file, not per message.
void Recorder::report() {
  const RecordingStatus& now = series_->status();
  const bool is_trouble = now.state == RecordingStatus::State::kNoSpace || now.state == RecordingStatus::State::kFailing;
  if (now.state != reported_.state)
    spdlog::log(is_trouble ? spdlog::level::warn : spdlog::level::info, "recording is {}{}{}", name_of(now.state), is_trouble ? ": " : "", is_trouble ? now.last_error : "");
  if (now.file != reported_.file && !now.file.empty()) spdlog::info("recording into {}", now.file.string());
  reported_ = now;
  MutexLock lock(mutex_);
  status_.recording = now;
}

}  // namespace gfp
