#include "replay/mcap_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gfp {

McapSource::McapSource(McapStreams streams, ReplayOptions options)
    : streams_(std::move(streams)), options_(std::move(options)),
      control_(options_.control ? options_.control : std::make_shared<ReplayControl>()),
      player_(control_->join(streams_.time(0), streams_.time(streams_.frames() - 1), options_.rate_hz > 0 ? options_.speed : 0)),
      position_(streams_.frames()) {}

SourceInfo McapSource::info() const {
  const double duration_s = std::chrono::duration<double>(streams_.time(streams_.frames() - 1) - streams_.time(0)).count();
  const double rate_hz = duration_s > 0 ? static_cast<double>(streams_.frames() - 1) / duration_s : 0;
  // Somebody who turns the knobs makes it slow or halt, which is no fault of the recording's.
  const bool is_steered = options_.control != nullptr;
  return {"replay", "MCAP recording", report_.file.string(), is_steered ? 0 : rate_hz, 0.0, 65.535, is_steered || !options_.loop, true};
}

Result<void> McapSource::open() {
  if (position_ >= streams_.frames()) position_ = first_at(start());
  speed_ = control_->state().speed;
  last_played_ = start();
  keep_time_from(start());
  return {};
}

/// Where all who share the control begin.
Nanoseconds McapSource::start() const { return control_->span().begin + Nanoseconds(std::llround(1e9 * options_.start_s)); }

std::size_t McapSource::first_at(Nanoseconds recorded_at) const {
  std::size_t low = 0, high = streams_.frames() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (streams_.time(middle) < recorded_at) low = middle + 1;
    else high = middle;
  }
  return low;
}

Nanoseconds McapSource::due(Nanoseconds recorded_at) const {
  return Nanoseconds(std::llround(static_cast<double>((recorded_at + pass_offset_ + seek_offset_ - control_->span().begin).count()) / speed_));
}

/// That time of the recording is now.
void McapSource::keep_time_from(Nanoseconds recorded_at) {
  pacer_.restart();
  if (speed_ > 0) pacer_.wait_until_due(due(recorded_at), std::chrono::milliseconds(0));
}

/// After a seek the stamps go on rising: as far as the play went on, not as far as the person jumped.
void McapSource::follow_control() {
  const ReplayControl::State state = control_->state();
  const bool has_new_speed = std::exchange(speed_, state.speed) != state.speed;
  if (const auto seek = control_->take_seek(player_)) {
    position_ = first_at(seek->target);
    seek_offset_ = seek->offset;
    keep_time_from(seek->target);
  } else if (has_new_speed) {
    keep_time_from(last_played_);
  }
  if (state.paused && position_ < streams_.frames()) keep_time_from(streams_.time(position_));  // a step: at once
}

Result<Frame> McapSource::grab(std::chrono::milliseconds timeout) {
  if (!control_->wait_until_running(player_, timeout)) return failure(ErrorCode::kPaused, "somebody holds the replay");
  follow_control();
  if (position_ >= streams_.frames() && !options_.loop) {
    control_->played(player_, last_played_, true);
    if (control_->holds_at_end()) {
      if (!control_->wait_for_seek(player_, timeout)) return failure(ErrorCode::kPaused, "the recording has come to its end and waits there");
      return grab(timeout);
    }
    return failure(ErrorCode::kEndOfStream, "the recording has come to its end");
  }
  if (position_ >= streams_.frames()) {
    position_ = first_at(start());
    pass_offset_ += control_->span().end + kAfterJump - start();
  }
  if (speed_ > 0 && !pacer_.wait_until_due(due(streams_.time(position_)), timeout)) return failure(ErrorCode::kTimeout, fmt::format("the next frame is not due within {} ms", timeout.count()));
  const std::size_t index = position_;
  position_ += static_cast<std::size_t>(options_.step);
  last_played_ = streams_.time(index);
  auto loaded = streams_.load(index);
  if (!loaded) return tl::unexpected<Error>(loaded.error());
  report_ = std::move(loaded->report);
  Frame frame = std::move(loaded->frame);
  frame.sequence = sequence_++;
  last_stamp_ = std::max(frame.stamps.sensor + pass_offset_ + seek_offset_, last_stamp_ + Nanoseconds(1));
  frame.stamps.sensor = last_stamp_;
  frame.stamps.monotonic = options_.frame_time ? last_stamp_ : monotonic_now();
  frame.stamps.realtime = options_.frame_time ? last_stamp_ : options_.recorded_time ? streams_.time(index) : realtime_now();
  control_->played(player_, last_played_, false);
  return frame;
}

Result<std::unique_ptr<McapSource>> open_mcap(const std::filesystem::path& file, const ReplayOptions& options) {
  if (!(options.rate_hz >= 0 && options.rate_hz <= 1000)) return failure(ErrorCode::kInvalidArgument, fmt::format("replay.rate_hz = {}, expected [0, 1000]", options.rate_hz));
  if (!(options.speed >= 0 && options.speed <= 1000)) return failure(ErrorCode::kInvalidArgument, fmt::format("replay.speed = {}, expected [0, 1000]", options.speed));
  if (!(options.start_s >= 0 && options.start_s <= 1e9)) return failure(ErrorCode::kInvalidArgument, fmt::format("replay.start_s = {}, expected [0, 1e9]", options.start_s));
  if (options.step < 1) return failure(ErrorCode::kInvalidArgument, fmt::format("replay.step = {}, expected at least 1", options.step));
  auto streams = McapStreams::open(file, options);
  if (!streams) return tl::unexpected<Error>(streams.error());
  return std::make_unique<McapSource>(std::move(*streams), options);
}

}  // namespace gfp
