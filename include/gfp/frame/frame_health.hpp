#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"
#include "gfp/frame/clock_fit.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// What may be wrong with a source, by names that programs can rely on.
namespace fault {
inline constexpr std::string_view kLost = "lost", kTimeout = "timeout", kHang = "hang", kCrash = "crash", kCorrupt = "corrupt", kWrongSize = "wrong_size", kNoReadings = "no_readings",
                                  kGarbage = "garbage", kStuck = "stuck", kSlow = "slow", kDelayed = "delayed", kIntermittent = "intermittent";
}  // namespace fault

struct FrameHealthOptions {
  int stuck_frames = 10;           ///< So many frames with the same pixels in a row mean a stuck sensor; 0: not looked for (recordings).
  double max_rough = 0.6;          ///< Share of neighbouring readings that differ by over a tenth; above it the frame is garbage. Real frames: below 0.1.
  double min_rate_share = 0.5;     ///< Of the nominal rate, over the last second; below it the source is slow.
  double max_gap_periods = 3.5;    ///< A longer pause between two frames is a gap; two in two seconds mean an intermittent source.
  double max_delay_s = 0.25;       ///< Later than the source's quickest frames of the last ten minutes by this: delayed.
};

template <class Visitor>
void visit_fields(FrameHealthOptions& o, Visitor&& field) {
  field("stuck_frames", o.stuck_frames, 0, 10'000);
  field("max_rough", o.max_rough, 0.1, 1.0);
  field("min_rate_share", o.min_rate_share, 0.0, 1.0);
  field("max_gap_periods", o.max_gap_periods, 1.0, 1000.0);
  field("max_delay_s", o.max_delay_s, 0.001, 60.0);
}

/// Watches the frames of one source: refuses those that no object may be made of, and names what is wrong with the others. Reads no clock: times are
/// the frames' own stamps. One thread at a time.
class FrameHealth {
 public:
  /// `rate_hz`: the source's nominal rate; 0: unknown, then it is neither slow nor intermittent. `may_repeat`: equal frames are no fault.
  FrameHealth(const FrameHealthOptions& options, double rate_hz, bool may_repeat);

  /// Refuses a frame with kCorruptFrame (the message begins with the fault's name); else notes its times. Cost: 0.1 ms at 640 x 480.
  Result<void> judge(const Frame& frame);
  /// Of the refused frame, or of the source as its last second shows it; empty: none.
  std::string_view fault() const { return fault_; }
  /// Device clock against the host's, as ClockFit says it.
  std::string_view clock_state() const { return clock_.state(); }
  /// When the frame judged last was taken, host time.
  Nanoseconds host_stamp() const { return host_stamp_; }
  void restart();  ///< The source was opened anew: its times have nothing to do with those before.

 private:
  Result<void> refuse(std::string_view fault, std::string what);
  Result<void> judge_pixels(const Frame& frame);
  void judge_times(const Stamps& stamps);

  FrameHealthOptions options_;
  double rate_hz_;
  std::string_view fault_;
  std::uint64_t last_hash_ = 0;
  int repeats_ = 0;
  std::deque<Nanoseconds> recent_;  ///< Arrivals of the last two seconds.
  ClockFit clock_;
  Nanoseconds host_stamp_{};
};

}  // namespace gfp
