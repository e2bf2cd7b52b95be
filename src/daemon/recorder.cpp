#include "daemon/recorder.hpp"

#include <fmt/format.h>
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
    : configured_mode_(options.mode),
      policy_(policy),
      storage_(std::move(storage)),
      is_on_(options.mode != "off"),
      options_(std::move(options)),
      series_(std::make_unique<RecordingSeries>(options_, *storage_)),
      clock_(std::make_unique<RecordingClock>(options_.content)) {
  status_.mode = configured_mode_;
  if (is_on_) launch();
}

Recorder::~Recorder() = default;

void Recorder::launch() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Recorder::push(Item item) {
  if (!is_on_) return;
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

Result<Recorder::Status> Recorder::control(Action action) {
  const std::string now = status().mode;
  if (action == Action::kStatus) return status();
  if (action == Action::kTrigger && now != "ring") return failure(ErrorCode::kInvalidArgument, fmt::format("recording.mode = {}, expected ring for a trigger", now));
  if (action == Action::kStart && !thread_.joinable()) launch();
  if (!thread_.joinable()) return status();  // nothing was ever recorded: there is nothing to stop
  is_on_ = action != Action::kStop || configured_mode_ == "ring";
  MutexLock lock(mutex_);
  if (action == Action::kTrigger) triggered_ = true;
  if (action == Action::kStart) next_mode_ = "continuous";
  if (action == Action::kStop) next_mode_ = configured_mode_ == "ring" ? "ring" : "off";
  const std::uint64_t ticket = ++asked_;
  changed_.notify_all();
  const bool is_done = changed_.wait_for(lock, kPatience, [this, ticket]() GFP_REQUIRES(mutex_) { return done_ >= ticket; });
  if (!is_done) return failure(ErrorCode::kTimeout, fmt::format("the recorder was not done within {} s", kPatience.count()));
  return status_;
}

/// Closes what is open. Another series of files begins with the next message: schemas, topologies and calibrations are in it anew.
void Recorder::change_mode(const std::string& mode) {
  if (mode == options_.mode) return;
  series_->close();
  report();
  before_ = reported_;
  options_.mode = mode;
  series_ = std::make_unique<RecordingSeries>(options_, *storage_);
  clock_->messages = wire::RecordingMessages(options_.content);
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
    std::optional<std::string> mode;
    std::uint64_t taken = 0;
    const std::chrono::milliseconds patience(is_on_ ? 50 : 1000);
    {
      MutexLock lock(mutex_);
      changed_.wait_for(lock, stop, patience, [this]() GFP_REQUIRES(mutex_) { return !waiting_.empty() || triggered_ || next_mode_; });
      items.swap(waiting_);
      triggered = std::exchange(triggered_, false);
      mode.swap(next_mode_);
      taken = asked_;
      stopped = stop.stop_requested();
      ended_ = stopped;
      changed_.notify_all();
    }
    record(items);
    if (mode) change_mode(*mode);
    if (triggered) series_->trigger(monotonic_now());
    series_->tick(monotonic_now());
    report();
    MutexLock lock(mutex_);
    done_ = taken;
    changed_.notify_all();
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
  RecordingStatus now = series_->status();
  const bool is_trouble = now.state == RecordingStatus::State::kNoSpace || now.state == RecordingStatus::State::kFailing;
  if (now.state != reported_.state)
    spdlog::log(is_trouble ? spdlog::level::warn : spdlog::level::info, "recording is {}{}{}", name_of(now.state), is_trouble ? ": " : "", is_trouble ? now.last_error : "");
  if (now.file != reported_.file && !now.file.empty()) spdlog::info("recording into {}", now.file.string());
  if (now.file.empty() && reported_.file.extension() == ".active") now.file = std::filesystem::path(reported_.file).replace_extension();  // as it is called when it is closed
  else if (now.file.empty()) now.file = reported_.file;
  now.files += before_.files;
  now.messages += before_.messages;
  now.bytes += before_.bytes;
  now.lost_messages += before_.lost_messages;
  now.write_errors += before_.write_errors;
  reported_ = now;
  MutexLock lock(mutex_);
  status_.recording = now;
  status_.mode = options_.mode;
}

}  // namespace gfp
