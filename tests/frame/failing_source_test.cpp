#include "gfp/frame/failing_source.hpp"

#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "gfp/frame/run_source.hpp"
#include "support/moving_wall.hpp"

namespace gfp {
namespace {

struct Outcome {
  SourceStatus status;
  std::set<std::string> faults;
  std::vector<FramePtr> frames;
  int opens = 0;
};

Outcome run(const std::string& mode, std::uint64_t for_frames, std::uint64_t frames = 120) {
  Outcome outcome;
  auto wall = std::make_unique<test::MovingWall>(frames);
  const test::MovingWall* const inner = wall.get();
  FailingSource source(std::move(wall), {mode, 20, for_frames, 1});
  SourceOptions options;
  options.reconnect = {0.001, 0.002};
  LatestSlot<FramePtr> slot(HandOver::kLossless);
  std::jthread taker([&] {
    while (auto taken = slot.take()) outcome.frames.push_back(std::move(*taken));
  });
  outcome.status = run_source(source, slot, options, {}, [&](const SourceStatus& status) { outcome.faults.insert(std::string(status.fault)); });
  taker.join();
  outcome.opens = inner->opens;
  return outcome;
}

// Every failure is named while it lasts, what is bad is not handed over, and at the end all is well again.
TEST(FailingSource, EveryBadPictureIsNamedAndHeldBack) {
  for (const char* mode : {"garbage", "no_readings", "wrong_size"}) {
    const Outcome outcome = run(mode, 30);
    EXPECT_TRUE(outcome.faults.contains(mode)) << mode;
    EXPECT_EQ(outcome.status.corrupt_frames, 30U) << mode;
    EXPECT_EQ(outcome.frames.size(), 90U) << mode;
    EXPECT_EQ(outcome.status.state, SourceState::kEnded) << mode;
  }
}

TEST(FailingSource, AStuckPictureIsNamedAfterTenFrames) {
  const Outcome outcome = run("stuck", 30);
  EXPECT_TRUE(outcome.faults.contains("stuck"));
  EXPECT_EQ(outcome.frames.size(), 120U - 30 + 9);  // the picture itself and nine of its repetitions pass
}

TEST(FailingSource, UnpluggedItIsOpenedUntilItIsBack) {
  const Outcome outcome = run("unplug", 3);
  EXPECT_TRUE(outcome.faults.contains("lost"));
  EXPECT_EQ(outcome.status.reconnects, 1U);
  EXPECT_EQ(outcome.opens, 2) << "three attempts are refused before the second one that reaches the source";
  EXPECT_EQ(outcome.frames.size(), 119U);
}

TEST(FailingSource, AJumpingClockShowsInItsState) {
  const Outcome outcome = run("clock_step", 1);
  EXPECT_EQ(outcome.frames.size(), 120U);
  EXPECT_LT(outcome.frames.back()->stamps.sensor, std::chrono::minutes(1)) << "in host time nothing jumped";
}

TEST(FailingSource, WithoutAFailureItIsTheSourceItself) {
  auto wall = std::make_unique<test::MovingWall>(1);
  const FrameSource* const inner = wall.get();
  EXPECT_EQ(with_failure(std::move(wall), {}).get(), inner);
}

}  // namespace
}  // namespace gfp
