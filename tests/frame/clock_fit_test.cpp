#include "gfp/frame/clock_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "gfp/core/random.hpp"
#include "gfp/frame/session_clock.hpp"

namespace gfp {
namespace {

constexpr double kShortestDelay_s = 0.004, kPeriod_s = 1.0 / 30;

Nanoseconds ns(double seconds) { return Nanoseconds(std::llround(1e9 * seconds)); }

/// A device whose clock drifts, behind a host that is sometimes busy.
struct Device {
  double drift_ppm = 0, offset_s = 0;
  Random random{1};

  Nanoseconds stamp(double host_s) const { return ns(offset_s + host_s * (1 - 1e-6 * drift_ppm)); }
  Nanoseconds arrival(double host_s) {
    const double jitter_s = -0.003 * std::log(1 - random.uniform());
    const double pause_s = random.uniform() < 0.02 ? 0.2 * random.uniform() : 0;
    return ns(host_s + kShortestDelay_s + jitter_s + pause_s);
  }
};

// However the device's clock drifts and however late frames arrive: stamps follow the host's clock, behind by the shortest delay, and never fall behind an arrival.
TEST(ClockFit, FollowsADriftingClockThroughLateFrames) {
  for (const double drift_ppm : {0.0, 60.0, -120.0}) {
    ClockFit clock;
    Device device{drift_ppm, -1234.5};
    Nanoseconds last{-1};
    double worst_s = 0;
    for (int i = 0; i < 30 * 1200; ++i) {  // twenty minutes
      const double taken_s = 1000 + i * kPeriod_s;
      const Nanoseconds arrival = device.arrival(taken_s), stamp = clock.to_host(device.stamp(taken_s), arrival);
      ASSERT_GT(stamp, last) << "frame " << i;
      ASSERT_LE(stamp, arrival) << "frame " << i;
      last = stamp;
      if (i > 30 * 30) worst_s = std::max(worst_s, std::abs(1e-9 * static_cast<double>((stamp - ns(taken_s + kShortestDelay_s)).count())));
    }
    EXPECT_LT(worst_s, 0.002) << drift_ppm << " ppm; twenty minutes of it are " << 1.2e-3 * drift_ppm << " s";
    EXPECT_NEAR(clock.drift_ppm(), drift_ppm, 5);
    EXPECT_EQ(clock.state(), "locked");
  }
}

TEST(ClockFit, AStepIsNamedForASecondAndTimeGoesOn) {
  for (const double step_s : {3600.0, -3600.0, -0.001}) {
    ClockFit clock;
    SessionClock session;  // as a driver has it
    Device device;
    Nanoseconds last{-1};
    int stepped = 0;
    for (int i = 0; i < 300; ++i) {
      const double taken_s = 1000 + i * kPeriod_s;
      if (i == 150) device.offset_s += step_s - kPeriod_s * (step_s < 0 ? 1 : 0);
      const Nanoseconds stamp = clock.to_host(session.stamp(device.stamp(taken_s)), ns(taken_s + kShortestDelay_s));
      ASSERT_GT(stamp, last);
      last = stamp;
      stepped += clock.state() == "stepped" ? 1 : 0;
      EXPECT_TRUE(i != 150 || clock.state() == "stepped") << step_s;
      EXPECT_NEAR(1e-9 * static_cast<double>(stamp.count()), taken_s + kShortestDelay_s, 0.001) << "frame " << i << " after " << step_s;
    }
    EXPECT_NEAR(stepped, 30, 2) << step_s;
    EXPECT_EQ(clock.state(), "locked");
  }
}

TEST(ClockFit, OpenedAnewItStartsAnewAndTimeGoesOn) {
  ClockFit clock;
  const Nanoseconds before = clock.to_host(ns(5), ns(100));
  for (int i = 1; i < 10; ++i) clock.to_host(ns(5 + i * kPeriod_s), ns(100 + i * kPeriod_s));
  EXPECT_EQ(clock.state(), "locked");
  clock.restart();
  EXPECT_EQ(clock.state(), "free");
  EXPECT_EQ(clock.to_host(ns(0), ns(200)), ns(200));
  EXPECT_GT(ns(200), before);
}

TEST(SessionClock, RisesWhateverTheDeviceDoes) {
  SessionClock session;
  EXPECT_EQ(session.stamp(ns(7)), Nanoseconds(0));
  EXPECT_EQ(session.stamp(ns(7.5)), ns(0.5));
  session.restart();
  EXPECT_EQ(session.stamp(ns(1)), ns(0.5) + Nanoseconds(1));
  EXPECT_EQ(session.stamp(ns(0)), ns(0.5) + Nanoseconds(2)) << "back";
  EXPECT_EQ(session.stamp(ns(0)), ns(0.5) + Nanoseconds(3)) << "stands still";
  EXPECT_EQ(session.stamp(ns(1)), ns(1.5) + Nanoseconds(3));
}

}  // namespace
}  // namespace gfp
