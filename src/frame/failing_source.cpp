#include "gfp/frame/failing_source.hpp"

#include <algorithm>
#include <csignal>
#include <thread>
#include <utility>

namespace gfp {
namespace {

constexpr double kDelay_s = 0.5;
constexpr int kBurst = 10, kLostOfBurst = 6;

double period_s(const SourceInfo& info) { return info.rate_hz > 0 ? 1 / info.rate_hz : 1.0 / 30; }

void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

}  // namespace

FailingSource::FailingSource(std::unique_ptr<FrameSource> source, FailureOptions options) : source_(std::move(source)), options_(std::move(options)) {}

Result<void> FailingSource::open() {
  if (opens_to_refuse_ > 0) {
    --opens_to_refuse_;
    return failure(ErrorCode::kDeviceLost, "unplugged on purpose");
  }
  return source_->open();
}

void FailingSource::close() noexcept {
  held_.clear();
  source_->close();
}

/// Counts the frame that comes next: whether it is one of the bad ones.
bool FailingSource::failing() {
  if (options_.times > 0 && times_ >= options_.times) return false;
  if (good_frames_ < options_.after_frames) return ++good_frames_, false;
  if (++bad_frames_ >= std::max<std::uint64_t>(1, options_.for_frames)) good_frames_ = bad_frames_ = 0, ++times_;
  return true;
}

Result<Frame> FailingSource::grab(std::chrono::milliseconds timeout) {
  Result<Frame> frame = source_->grab(timeout);
  if (!frame) return frame;
  frame->stamps.sensor += clock_offset_;
  if (failing()) return fail(std::move(*frame), timeout);
  last_ = frame->depth;
  if (held_.empty()) return frame;
  held_.clear();  // late frames that are overtaken are lost
  return frame;
}

Result<Frame> FailingSource::fail(Frame frame, std::chrono::milliseconds timeout) {
  const bool first = bad_frames_ == 1 || options_.for_frames <= 1;
  if (options_.mode == "unplug" || options_.mode == "hang" || options_.mode == "crash") good_frames_ = bad_frames_ = 0, times_ += first && options_.for_frames > 1 ? 1 : 0;
  if (options_.mode == "unplug") {
    opens_to_refuse_ = options_.for_frames;
    return failure(ErrorCode::kDeviceLost, "unplugged on purpose");
  }
  if (options_.mode == "crash") std::raise(SIGSEGV);
  if (options_.mode == "hang") {
    sleep_s(static_cast<double>(options_.for_frames));
    return failure(ErrorCode::kTimeout, "hung on purpose");
  }
  if (options_.mode == "slow") sleep_s(4 * period_s(info()));
  if (options_.mode == "intermittent" && bad_frames_ % kBurst < kLostOfBurst) return grab(timeout);
  if (options_.mode == "clock_step" && first) clock_offset_ += std::chrono::hours(1), frame.stamps.sensor += std::chrono::hours(1);
  if (options_.mode == "delayed") {
    held_.push_back(std::move(frame));
    if (static_cast<double>(held_.size()) * period_s(info()) < kDelay_s) return grab(timeout);
    frame = std::move(held_.front());
    held_.pop_front();
  }
  spoil(frame);
  if (options_.mode == "slow" || options_.mode == "delayed") frame.stamps.monotonic = monotonic_now(), frame.stamps.realtime = realtime_now();
  return frame;
}

void FailingSource::spoil(Frame& frame) {
  auto& pixels = frame.depth.pixels.pixels;
  if (options_.mode == "garbage")
    for (auto& pixel : pixels) pixel = static_cast<std::uint16_t>(random_.below(65536));
  if (options_.mode == "no_readings") std::fill(pixels.begin(), pixels.end(), std::uint16_t{0});
  if (options_.mode == "stuck") frame.depth = last_;
  if (options_.mode == "wrong_size") frame.depth.pixels = Image<std::uint16_t>(frame.depth.pixels.width / 2, frame.depth.pixels.height / 2, 1000);
}

std::unique_ptr<FrameSource> with_failure(std::unique_ptr<FrameSource> source, const FailureOptions& options) {
  if (options.mode == "none") return source;
  return std::make_unique<FailingSource>(std::move(source), options);
}

}  // namespace gfp
