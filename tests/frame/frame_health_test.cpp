#include "gfp/frame/frame_health.hpp"

#include <gtest/gtest.h>

#include "support/moving_wall.hpp"

namespace gfp {
namespace {

using test::wall_frame;

constexpr double kRate_hz = 30;

/// Judges frames at the given times and says the last fault.
std::string_view fault_after(FrameHealth& health, const std::vector<double>& times_s, double late_s = 0.01) {
  static std::uint64_t sequence = 0;
  for (const double time_s : times_s) EXPECT_TRUE(health.judge(wall_frame(sequence++, time_s, late_s)));
  return health.fault();
}

std::vector<double> every(double period_s, int count, double from_s = 0) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(from_s + period_s * i);
  return times;
}

TEST(FrameHealth, FramesInTimeHaveNoFault) {
  FrameHealth health({}, kRate_hz, false);
  EXPECT_EQ(fault_after(health, every(1 / kRate_hz, 90)), "");
  EXPECT_EQ(health.clock_state(), "locked");
}

TEST(FrameHealth, AQuarterOfTheRateIsSlowWithinASecond) {
  FrameHealth health({}, kRate_hz, false);
  EXPECT_EQ(fault_after(health, every(1 / kRate_hz, 30)), "");
  EXPECT_EQ(fault_after(health, every(0.25, 5, 1.25)), fault::kSlow);
  EXPECT_EQ(fault_after(health, every(1 / kRate_hz, 90, 2.5)), "") << "and it recovers";
}

// At the edge between slow and intermittent the fault keeps its name: a change is a line in the log.
TEST(FrameHealth, AFaultOfPaceDoesNotChangeItsNameByTurns) {
  FrameHealth health({}, kRate_hz, false);
  std::string_view last;
  int changes = 0;
  std::uint64_t sequence = 0;
  double time_s = 0;
  for (int i = 0; i < 200; ++i) {
    time_s += i % 2 == 0 ? 0.13 : 0.047;
    ASSERT_TRUE(health.judge(wall_frame(sequence++, time_s)));
    changes += health.fault() != last ? 1 : 0;
    last = health.fault();
  }
  EXPECT_GE(changes, 1);
  EXPECT_LE(changes, 2) << "intermittent, then slow";
}

TEST(FrameHealth, PausesBetweenFramesAtTheRightPaceAreIntermittent) {
  FrameHealth health({}, kRate_hz, false);
  fault_after(health, every(1 / kRate_hz, 30));
  for (int burst = 0; burst < 3; ++burst) fault_after(health, every(1 / kRate_hz, 6, 1.2 + burst * 0.4));
  EXPECT_EQ(health.fault(), fault::kIntermittent);
}

TEST(FrameHealth, FramesThatArriveLateAreDelayed) {
  FrameHealth health({}, kRate_hz, false);
  fault_after(health, every(1 / kRate_hz, 30));
  EXPECT_EQ(fault_after(health, every(1 / kRate_hz, 10, 1), 0.31), fault::kDelayed);
  EXPECT_EQ(health.clock_state(), "locked") << "late frames are no stepped clock";
}

TEST(FrameHealth, AClockThatJumpsIsSteppedForASecond) {
  FrameHealth health({}, kRate_hz, false);
  fault_after(health, every(1 / kRate_hz, 30));
  Frame jumped = wall_frame(1000, 1.1);
  jumped.stamps.sensor += std::chrono::hours(1);
  ASSERT_TRUE(health.judge(jumped));
  EXPECT_EQ(health.clock_state(), "stepped");
  for (int i = 1; i < 40; ++i) {
    Frame next = wall_frame(1000 + static_cast<std::uint64_t>(i), 1.1 + i / kRate_hz);
    next.stamps.sensor += std::chrono::hours(1);
    ASSERT_TRUE(health.judge(next));
  }
  EXPECT_EQ(health.clock_state(), "locked");
  EXPECT_EQ(health.fault(), "");
}

TEST(FrameHealth, RefusesWhatNoObjectMayBeMadeOf) {
  FrameHealth health({}, kRate_hz, false);
  Frame small = wall_frame(1, 0.1);
  small.depth.pixels = Image<std::uint16_t>(32, 24, 1000);
  EXPECT_EQ(health.judge(small).error().what, "wrong_size: depth is 32 x 24, expected the camera's 64 x 48");
  Frame empty = wall_frame(2, 0.2);
  std::fill(empty.depth.pixels.pixels.begin(), empty.depth.pixels.pixels.end(), std::uint16_t{0});
  EXPECT_EQ(health.judge(empty).error().what, "no_readings: none of 3072 pixels has a reading");
  Frame noise = wall_frame(3, 0.3);
  for (std::size_t i = 0; i < noise.depth.pixels.pixels.size(); ++i) noise.depth.pixels.pixels[i] = static_cast<std::uint16_t>(i * 40503);
  EXPECT_FALSE(health.judge(noise));
  EXPECT_EQ(health.fault(), fault::kGarbage);
  EXPECT_TRUE(health.judge(wall_frame(4, 0.4)));
  EXPECT_EQ(health.fault(), "");
}

TEST(FrameHealth, EqualFramesAreStuckUnlessTheyMayRepeat) {
  FrameHealth health({}, kRate_hz, false), replayed({}, kRate_hz, true);
  int passed = 0;
  for (int i = 0; i < 30; ++i) {
    Frame same = wall_frame(7, 0.0);
    same.stamps = wall_frame(7, i / kRate_hz).stamps;
    passed += health.judge(same) ? 1 : 0;
    EXPECT_TRUE(replayed.judge(same));
  }
  EXPECT_EQ(passed, 10);
  EXPECT_EQ(health.fault(), fault::kStuck);
}

}  // namespace
}  // namespace gfp
