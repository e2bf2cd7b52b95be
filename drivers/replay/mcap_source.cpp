#include "replay/mcap_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gfp {

McapSource::McapSource(McapStreams streams, ReplayOptions options)
    : streams_(std::move(streams)), options_(std::move(options)),
      control_(options_.control ? options_.control : std::make_shared<ReplayControl>()) {
  const double speed = options_.rate_hz > 0 ? options_.speed : 0;
  control_->begin(streams_.time(0), since_begin(streams_.frames() - 1), speed);
  position_ = first_at(Nanoseconds(std::llround(1e9 * options_.start_s)));
}

SourceInfo McapSource::info() const {
  const double duration_s = std::chrono::duration<double>(since_begin(streams_.frames() - 1)).count();
  const double rate_hz = duration_s > 0 ? static_cast<double>(streams_.frames() - 1) / duration_s : 0;
  // Somebody who turns the knobs makes it slow or halt, which is no fault of the recording's.
  const bool is_steered = options_.control != nullptr;
  return {"replay", "MCAP recording", report_.file.string(), is_steered ? 0 : rate_hz, 0.0, 65.535, is_steered || !options_.loop, true};
}

Result<void> McapSource::open() {
  if (position_ >= streams_.frames()) position_ = first_at(Nanoseconds(std::llround(1e9 * options_.start_s)));
  pacer_.restart();
  return {};
}

std::size_t McapSource::first_at(Nanoseconds position) const {
  std::size_t low = 0, high = streams_.frames() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (since_begin(middle) < position) low = middle + 1;
    else high = middle;
  }
  return low;
}

/// After a seek the stamps go on rising: as far as the play went on, not as far as the person jumped.
void McapSource::follow_control() {
  if (const auto target = control_->take_seek()) {
    position_ = first_at(*target);
    pacer_.restart();
    if (sequence_ > 0) pass_offset_ += last_played_ + Nanoseconds(33'333'333) - since_begin(position_);
    last_played_ = since_begin(position_);
  }
  if (const double speed = control_->state().speed; speed != speed_) {
    speed_ = speed;
    pacer_.restart();
  }
}

Result<Frame> McapSource::grab(std::chrono::milliseconds timeout) {
  if (!control_->wait_until_running(timeout)) return failure(ErrorCode::kPaused, "somebody holds the replay");
  follow_control();
  if (position_ >= streams_.frames() && !options_.loop) {
    control_->played(last_played_, true);
    if (control_->holds_at_end()) {
      if (!control_->wait_for_seek(timeout)) return failure(ErrorCode::kPaused, "the recording has come to its end and waits there");
      return grab(timeout);
    }
    return failure(ErrorCode::kEndOfStream, "the recording has come to its end");
  }
  if (position_ >= streams_.frames()) {
    position_ = first_at(Nanoseconds(std::llround(1e9 * options_.start_s)));
    pass_offset_ += last_played_ + Nanoseconds(33'333'333) - since_begin(position_);
  }
  const Nanoseconds played = since_begin(position_) + pass_offset_;
  if (speed_ > 0) due_ = Nanoseconds(std::llround(static_cast<double>(played.count()) / speed_));
  if (speed_ > 0 && !pacer_.wait_until_due(due_, timeout)) return failure(ErrorCode::kTimeout, fmt::format("the next frame is not due within {} ms", timeout.count()));
  const std::size_t index = position_;
  position_ += static_cast<std::size_t>(options_.step);
  last_played_ = since_begin(index);
  auto loaded = streams_.load(index);
  if (!loaded) return tl::unexpected<Error>(loaded.error());
  report_ = std::move(loaded->report);
  Frame frame = std::move(loaded->frame);
  frame.sequence = sequence_++;
  last_stamp_ = std::max(frame.stamps.sensor + pass_offset_, last_stamp_ + Nanoseconds(1));
  frame.stamps.sensor = last_stamp_;
  frame.stamps.monotonic = options_.frame_time ? last_stamp_ : monotonic_now();
  frame.stamps.realtime = options_.frame_time ? last_stamp_ : options_.recorded_time ? streams_.time(index) : realtime_now();
  control_->played(last_played_, false);
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
