#include "replay/replay_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "replay/axes.hpp"

namespace gfp {
namespace {

std::vector<ReplayEntry> every(std::vector<ReplayEntry> entries, int step) {
  std::vector<ReplayEntry> kept;
  for (std::size_t i = 0; i < entries.size(); i += static_cast<std::size_t>(step)) kept.push_back(std::move(entries[i]));
  return kept;
}

}  // namespace

ReplaySource::ReplaySource(std::vector<ReplayEntry> entries, ReplayOptions options)
    : entries_(every(std::move(entries), options.step)), options_(std::move(options)),
      stamped_(std::all_of(entries_.begin(), entries_.end(), [](const ReplayEntry& e) { return e.stamp.has_value(); })) {}

SourceInfo ReplaySource::info() const {
  return {"replay", "recording", entries_.front().depth.string(), options_.rate_hz, 0.0, 65.535, !options_.loop, true};
}

Result<void> ReplaySource::open() {
  if (position_ >= entries_.size()) position_ = 0;
  pacer_.restart();
  return {};
}

void ReplaySource::close() noexcept { pacer_.restart(); }

Nanoseconds ReplaySource::period() const {
  return Nanoseconds(std::llround(1e9 / (options_.rate_hz > 0 ? options_.rate_hz : 30.0)));
}

Nanoseconds ReplaySource::recorded_stamp(std::size_t index) const {
  return stamped_ ? *entries_[index].stamp : static_cast<std::int64_t>(index) * period();
}

Result<LoadedFrame> ReplaySource::load(std::size_t index) {
  if (only_) return *only_;
  Result<LoadedFrame> loaded = load_frame(entries_[index], options_);
  if (loaded && entries_.size() == 1 && options_.loop) only_ = *loaded;
  return loaded;
}

Result<Frame> ReplaySource::grab(std::chrono::milliseconds timeout) {
  if (position_ >= entries_.size() && !options_.loop) return failure(ErrorCode::kEndOfStream, "the recording has come to its end");
  if (options_.rate_hz > 0 && !pacer_.wait_until_due(static_cast<std::int64_t>(played_) * period(), timeout))
    return failure(ErrorCode::kTimeout, fmt::format("the next frame is not due within {} ms", timeout.count()));
  if (position_ >= entries_.size()) {
    position_ = 0;
    pass_offset_ = last_stamp_ + period() - recorded_stamp(0);
  }
  const std::size_t index = position_++;
  ++played_;
  Result<LoadedFrame> loaded = load(index);
  if (!loaded) return tl::unexpected<Error>(loaded.error());
  report_ = std::move(loaded->report);
  Frame frame = std::move(loaded->frame);
  frame.sequence = sequence_++;
  // Two files with one stamp, or out of order: the time of a session still only goes forward.
  last_stamp_ = std::max(recorded_stamp(index) + pass_offset_, last_stamp_ + Nanoseconds(1));
  frame.stamps.sensor = last_stamp_;
  frame.stamps.monotonic = options_.frame_time ? last_stamp_ : monotonic_now();
  frame.stamps.realtime = options_.frame_time ? last_stamp_ : realtime_now();
  return frame;
}

Result<std::unique_ptr<ReplaySource>> open_replay(const std::filesystem::path& input, const ReplayOptions& options) {
  if (!(options.rate_hz >= 0 && options.rate_hz <= 1000))
    return failure(ErrorCode::kInvalidArgument, fmt::format("replay.rate_hz = {}, expected [0, 1000]", options.rate_hz));
  if (options.step < 1) return failure(ErrorCode::kInvalidArgument, fmt::format("replay.step = {}, expected at least 1", options.step));
  if (!options.axes.empty())
    if (const Result<Axes> axes = parse_axes(options.axes); !axes) return tl::unexpected<Error>(axes.error());
  Result<std::vector<ReplayEntry>> entries = list_replay(input);
  if (!entries) return tl::unexpected<Error>(entries.error());
  return std::make_unique<ReplaySource>(std::move(*entries), options);
}

}  // namespace gfp
