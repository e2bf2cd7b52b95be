#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "gfp/core/fields.hpp"
#include "gfp/core/random.hpp"
#include "gfp/frame/frame_source.hpp"

namespace gfp {

/// A failure on purpose, for drills and tests: frames and calls are counted, so that it comes at the same place every time.
struct FailureOptions {
  std::string mode = "none";
  std::uint64_t after_frames = 60;   ///< Good frames before it, and between two of it.
  std::uint64_t for_frames = 30;     ///< So long it lasts: frames, for `unplug` attempts to open, for `hang` seconds.
  std::uint64_t times = 1;           ///< 0: for ever.
};

template <class Visitor>
void visit_fields(FailureOptions& o, Visitor&& field) {
  field("mode", o.mode, OneOf{{"none", "unplug", "hang", "crash", "garbage", "stuck", "slow", "delayed", "intermittent", "no_readings", "wrong_size", "clock_step"}});
  field("after_frames", o.after_frames, std::uint64_t{0}, UINT64_MAX);
  field("for_frames", o.for_frames, std::uint64_t{0}, UINT64_MAX);
  field("times", o.times, std::uint64_t{0}, UINT64_MAX);
}

/// Makes any source fail as configured.
///
///     unplug        grab() says kDeviceLost, and so does open(), `for_frames` times
///     hang          grab() does not return for `for_frames` seconds
///     crash         the process ends by a segmentation fault: with `isolation: process` only
///     garbage       random readings          stuck     the same picture again and again
///     no_readings   zeros everywhere         wrong_size   half the picture
///     slow          every frame takes four periods more
///     delayed       frames arrive half a second after they were taken
///     intermittent  of ten frames six are lost
///     clock_step    the device clock jumps by an hour, once
class FailingSource final : public FrameSource {
 public:
  FailingSource(std::unique_ptr<FrameSource> source, FailureOptions options);

  SourceInfo info() const override { return source_->info(); }
  Result<void> open() override;
  Result<Frame> grab(std::chrono::milliseconds timeout) override;
  void close() noexcept override;

 private:
  bool failing();
  Result<Frame> fail(Frame frame, std::chrono::milliseconds timeout);
  void spoil(Frame& frame);

  const std::unique_ptr<FrameSource> source_;
  const FailureOptions options_;
  std::uint64_t good_frames_ = 0, bad_frames_ = 0, times_ = 0;
  std::uint64_t opens_to_refuse_ = 0;
  Random random_{1};
  DepthImage last_;
  std::deque<Frame> held_;
  Nanoseconds clock_offset_{};
};

/// The source itself where `options.mode` is none.
std::unique_ptr<FrameSource> with_failure(std::unique_ptr<FrameSource> source, const FailureOptions& options);

}  // namespace gfp
