#include "gfp/frame/run_source.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "support/scripted_source.hpp"

namespace gfp {
namespace {

using test::fault;
using test::frame;
using test::open_fault;
using test::ScriptedSource;
using enum SourceState;

SourceOptions fast_options() {
  SourceOptions options;
  options.reconnect = {0.001, 0.002};
  options.stalls_before_reopen = 3;
  return options;
}

struct Outcome {
  SourceStatus status;
  std::vector<SourceState> changes;
  std::vector<std::uint64_t> sequences;
};

/// Runs the script to its end with a lossless slot, so that every frame is seen.
Outcome run(ScriptedSource& source, const SourceOptions& options = fast_options()) {
  Outcome outcome;
  LatestSlot<FramePtr> slot(HandOver::kLossless);
  std::jthread taker([&] {
    while (const auto taken = slot.take()) outcome.sequences.push_back((*taken)->sequence);
  });
  outcome.status = run_source(source, slot, options, {}, [&](const SourceStatus& s) {
    if (outcome.changes.empty() || outcome.changes.back() != s.state) outcome.changes.push_back(s.state);  // the fault alone may change too
  });
  taker.join();
  return outcome;
}

TEST(RunSource, DeliversFramesAndReconnectsOnceAfterALoss) {
  ScriptedSource source({frame(1), fault(ErrorCode::kDeviceLost), frame(2)});
  const Outcome outcome = run(source);
  EXPECT_EQ(outcome.sequences, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(outcome.changes, (std::vector{kStreaming, kLost, kStreaming, kEnded}));
  EXPECT_EQ(outcome.status.reconnects, 1U);
  EXPECT_EQ(outcome.status.frames, 2U);
  EXPECT_EQ(source.opens, 2);
  EXPECT_EQ(source.closes, 2);
}

TEST(RunSource, CountsTimeoutsAndCorruptFramesAndSaysStalledOnce) {
  ScriptedSource source({frame(1), fault(ErrorCode::kTimeout), fault(ErrorCode::kCorruptFrame), frame(2),
                         fault(ErrorCode::kCorruptData), frame(3)});
  const Outcome outcome = run(source);
  EXPECT_EQ(outcome.sequences, (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(outcome.changes, (std::vector{kStreaming, kStalled, kStreaming, kStalled, kStreaming, kEnded}));
  EXPECT_EQ(outcome.status.timeouts, 1U);
  EXPECT_EQ(outcome.status.corrupt_frames, 2U);
  EXPECT_EQ(outcome.status.reconnects, 0U);
  EXPECT_EQ(source.opens, 1);
}

// However long: a recording that is held is neither stuck nor lost.
TEST(RunSource, WaitsForARecordingThatIsHeld) {
  ScriptedSource source({frame(1), test::paused(), test::paused(), test::paused(), test::paused(), test::paused(), frame(2)});
  const Outcome outcome = run(source);
  EXPECT_EQ(outcome.sequences, (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(outcome.changes, (std::vector{kStreaming, kPaused, kStreaming, kEnded}));
  EXPECT_EQ(outcome.status.timeouts, 0U);
  EXPECT_EQ(source.opens, 1);
}

TEST(RunSource, ReopensAStuckDevice) {
  const auto timeout = fault(ErrorCode::kTimeout);
  ScriptedSource source({frame(1), timeout, timeout, timeout, frame(2)});
  const Outcome outcome = run(source);
  EXPECT_EQ(outcome.changes, (std::vector{kStreaming, kStalled, kLost, kStreaming, kEnded}));
  EXPECT_EQ(outcome.status.timeouts, 3U);
  EXPECT_EQ(outcome.status.reconnects, 1U);
  EXPECT_EQ(source.opens, 2);
}

TEST(RunSource, TriesAgainWhenADeviceIsNotThereYet) {
  ScriptedSource source({open_fault(ErrorCode::kNotFound), open_fault(ErrorCode::kDeviceLost), frame(1)});
  const Outcome outcome = run(source);
  EXPECT_EQ(outcome.changes, (std::vector{kLost, kStreaming, kEnded}));
  EXPECT_EQ(outcome.status.reconnects, 0U);  // it had never streamed before
  EXPECT_EQ(source.opens, 3);
}

TEST(RunSource, DoesNotRetryWhatAPersonMustFix) {
  for (const ErrorCode code : {ErrorCode::kInvalidArgument, ErrorCode::kUnsupported, ErrorCode::kCorruptData, ErrorCode::kTooLarge}) {
    ScriptedSource source({open_fault(code), frame(1)});
    const Outcome outcome = run(source);
    EXPECT_EQ(outcome.changes, std::vector{kFailed}) << to_string(code);
    ASSERT_TRUE(outcome.status.last_error.has_value());
    EXPECT_EQ(outcome.status.last_error->code, code);
    EXPECT_EQ(source.opens, 1);
  }
}

TEST(RunSource, StopsBetweenFrames) {
  std::stop_source stop;
  auto second = frame(2);
  second.effect = [&] { stop.request_stop(); };
  ScriptedSource source({frame(1), second, frame(3)});
  LatestSlot<FramePtr> slot;
  const SourceStatus status = run_source(source, slot, fast_options(), stop.get_token());
  EXPECT_EQ(status.state, kStopped);
  EXPECT_EQ(status.frames, 2U);
  EXPECT_EQ(slot.dropped(), 1U);
  EXPECT_EQ((*slot.take())->sequence, 2U);
  EXPECT_TRUE(slot.finished());
}

TEST(RunSource, StopsInTheMiddleOfALongBackoff) {
  std::stop_source stop;
  ScriptedSource source({open_fault(ErrorCode::kNotFound)});
  SourceOptions options = fast_options();
  options.reconnect = {3600, 3600};
  LatestSlot<FramePtr> slot;
  // Stop is requested from the callback that says `lost`, so the pause of an hour is cut before it begins.
  const SourceStatus status = run_source(source, slot, options, stop.get_token(), [&](const SourceStatus&) { stop.request_stop(); });
  EXPECT_EQ(status.state, kStopped);
}

TEST(Backoff, DoublesUpToItsMaximumAndStartsAnew) {
  Backoff backoff({0.5, 3.0});
  for (const double expected : {0.5, 1.0, 2.0, 3.0, 3.0}) EXPECT_DOUBLE_EQ(backoff.next_s(), expected);
  backoff.reset();
  EXPECT_DOUBLE_EQ(backoff.next_s(), 0.5);
}

}  // namespace
}  // namespace gfp
