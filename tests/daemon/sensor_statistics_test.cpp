#include "daemon/sensor_statistics.hpp"

#include <gtest/gtest.h>

namespace gfp {
namespace {

using namespace std::chrono_literals;

TEST(SensorStatistics, RatesAndQuantilesAreOfTheWindow) {
  SensorStatistics statistics(10s);
  for (int i = 0; i < 60; ++i) statistics.frame_arrived();
  for (int i = 1; i <= 100; ++i) statistics.scene_done(std::chrono::milliseconds(i));
  statistics.turn(12s);
  const auto rates = statistics.rates();
  EXPECT_DOUBLE_EQ(rates.fps, 30);
  EXPECT_DOUBLE_EQ(rates.scenes_fps, 50);
  EXPECT_DOUBLE_EQ(rates.latency_p50_ms, 50);  // nearest rank of 1..100
  EXPECT_DOUBLE_EQ(rates.latency_p99_ms, 99);
  EXPECT_EQ(rates.frames, 60U);
}

TEST(SensorStatistics, AnEmptyWindowIsZeroAndTheCountGoesOn) {
  SensorStatistics statistics(0s);
  statistics.frame_arrived();
  statistics.turn(1s);
  statistics.turn(2s);
  EXPECT_EQ(statistics.rates().fps, 0);
  EXPECT_EQ(statistics.rates().latency_p99_ms, 0);
  EXPECT_EQ(statistics.rates().frames, 1U);
}

TEST(SensorStatistics, OneSceneIsEveryQuantile) {
  SensorStatistics statistics(0s);
  statistics.scene_done(7ms);
  statistics.turn(1s);
  EXPECT_DOUBLE_EQ(statistics.rates().latency_p50_ms, 7);
  EXPECT_DOUBLE_EQ(statistics.rates().latency_p99_ms, 7);
}

}  // namespace
}  // namespace gfp
