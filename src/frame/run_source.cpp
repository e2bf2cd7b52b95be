#include "gfp/frame/run_source.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

// States:  connecting -> streaming <-> stalled, paused; stalled -> lost -> (back-off) connecting ...
//          any -> ended | failed | stopped, which are final.

namespace gfp {
namespace {

constexpr double kAbsentPause_s = 0.5;  // between looks for a device that is not there: it is to be back soon after it was plugged in

/// A wrong path or option stays wrong; a device that is not there may come.
bool is_permanent(ErrorCode code) {
  return code == ErrorCode::kInvalidArgument || code == ErrorCode::kUnsupported || code == ErrorCode::kCorruptData ||
         code == ErrorCode::kTooLarge;
}

bool is_final(SourceState state) {
  return state == SourceState::kEnded || state == SourceState::kFailed || state == SourceState::kStopped;
}

/// Errors say their fault at the beginning of their text where the code alone does not.
std::string_view fault_of(const Error& error) {
  for (const std::string_view name : {fault::kHang, fault::kCrash, fault::kWrongSize, fault::kNoReadings, fault::kGarbage, fault::kStuck})
    if (error.what.starts_with(name) && error.what.size() > name.size() && error.what[name.size()] == ':') return name;
  if (error.code == ErrorCode::kTimeout) return fault::kTimeout;
  return error.code == ErrorCode::kDeviceLost || error.code == ErrorCode::kNotFound || error.code == ErrorCode::kIo ? fault::kLost : fault::kCorrupt;
}

/// One call of run_source(): the status and who is told about it.
class Run {
 public:
  Run(FrameSource& source, LatestSlot<FramePtr>& out, const SourceOptions& options, const std::stop_token& stop,
      const std::function<void(const SourceStatus&)>& on_change)
      : source_(source), out_(out), options_(options), stop_(stop), on_change_(on_change),
        health_(options.health, source.info().rate_hz, source.info().finite || source.info().may_repeat) {}

  SourceStatus until_final() {
    Backoff backoff(options_.reconnect);
    while (!is_final(status_.state)) {
      const bool opened = open();
      if (opened) stream(backoff);
      source_.close();
      // The back-off is part of being lost: a frame, not a successful open(), proves that the device is back.
      const bool absent = !opened && status_.last_error && fault_of(*status_.last_error) == fault::kLost;
      const double pause_s = backoff.next_s();
      if (!is_final(status_.state) && !sleep_for(absent ? std::min(pause_s, kAbsentPause_s) : pause_s, stop_)) change(SourceState::kStopped);
    }
    out_.close();
    return status_;
  }

 private:
  bool open() {
    if (stop_.stop_requested()) return change(SourceState::kStopped), false;
    const Result<void> opened = source_.open();
    health_.restart();
    if (opened) return true;
    status_.last_error = opened.error();
    next_fault_ = is_permanent(opened.error().code) ? std::string_view() : fault_of(opened.error());
    change(is_permanent(opened.error().code) ? SourceState::kFailed : SourceState::kLost);
    return false;
  }

  void stream(Backoff& backoff) {
    const auto timeout = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * options_.grab_timeout_s));
    for (int stalls = 0; stalls < options_.stalls_before_reopen;) {
      if (stop_.stop_requested()) return change(SourceState::kStopped);
      Result<Frame> frame = source_.grab(timeout);
      if (frame) frame = health_.judge(*frame).map([&] { return std::move(*frame); });
      if (frame) {
        if (!source_.info().finite) frame->stamps.sensor = health_.host_stamp();
        if (!deliver(std::move(*frame))) return change(SourceState::kStopped);
        backoff.reset();
        stalls = 0;
        continue;
      }
      if (frame.error().code == ErrorCode::kPaused) {
        next_fault_ = {};
        health_.restart();
        change(SourceState::kPaused);
        continue;
      }
      status_.last_error = frame.error();
      next_fault_ = fault_of(frame.error());
      if (frame.error().code == ErrorCode::kEndOfStream) return change(SourceState::kEnded);
      if (frame.error().code == ErrorCode::kDeviceLost) return change(SourceState::kLost);
      ++(frame.error().code == ErrorCode::kTimeout ? status_.timeouts : status_.corrupt_frames);
      ++stalls;
      change(status_.state == SourceState::kStreaming ? SourceState::kStalled : status_.state);
    }
    change(SourceState::kLost);
  }

  bool deliver(Frame frame) {
    if (!out_.put(std::make_shared<const Frame>(std::move(frame)), stop_)) return false;
    ++status_.frames;
    if (was_lost_) ++status_.reconnects;
    was_lost_ = false;
    next_fault_ = health_.fault();
    change(SourceState::kStreaming);
    return true;
  }

  void change(SourceState state) {
    if (state == SourceState::kLost && status_.frames > 0) was_lost_ = true;
    const bool ended = state == SourceState::kEnded || state == SourceState::kStopped;
    const std::string_view fault = ended ? std::string_view() : next_fault_;
    if (state == status_.state && fault == status_.fault && status_.clock_state == health_.clock_state()) return;
    status_.state = state;
    status_.fault = fault;
    status_.clock_state = health_.clock_state();
    if (on_change_) on_change_(status_);
  }

  FrameSource& source_;
  LatestSlot<FramePtr>& out_;
  const SourceOptions& options_;
  const std::stop_token& stop_;
  const std::function<void(const SourceStatus&)>& on_change_;
  FrameHealth health_;
  SourceStatus status_;
  std::string_view next_fault_;  ///< Of the status with the next change.
  bool was_lost_ = false;
};

}  // namespace

std::string_view to_string(SourceState state) {
  switch (state) {
    case SourceState::kConnecting: return "connecting";
    case SourceState::kStreaming: return "streaming";
    case SourceState::kStalled: return "stalled";
    case SourceState::kPaused: return "paused";
    case SourceState::kLost: return "lost";
    case SourceState::kEnded: return "ended";
    case SourceState::kFailed: return "failed";
    case SourceState::kStopped: return "stopped";
  }
  return "unknown";
}

SourceStatus run_source(FrameSource& source, LatestSlot<FramePtr>& out, const SourceOptions& options,
                        const std::stop_token& stop, const std::function<void(const SourceStatus&)>& on_change) {
  return Run(source, out, options, stop, on_change).until_final();
}

}  // namespace gfp
