#include "gfp/frame/kinect_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "freenect/register_color.hpp"
#include "freenect/tick_clock.hpp"

namespace gfp {
namespace {

// Raw values are disparity: at z they are slope z^2 apart, so the nearest one is at most half of that away.
TEST(KinectDepth, RoundsToTheNearestRawValue) {
  const KinectDepthTable table = kinect_depth_table();
  const double slope = -KinectDepthCalibration{}.inverse_slope_per_m;
  for (double z = 0.4; z < 6; z += 0.0137) {
    const std::uint16_t raw = kinect_raw_of(z);
    ASSERT_LT(raw, kKinectNoReading) << z;
    EXPECT_NEAR(kKinectDepthScale_m * table[raw], z, 0.52 * slope * z * z + kKinectDepthScale_m) << z;
  }
}

TEST(KinectDepth, RisesWithTheRawValueAndEndsAtInfinity) {
  const KinectDepthTable table = kinect_depth_table();
  for (std::size_t raw = 1; raw < 1050; ++raw) EXPECT_GE(table[raw], table[raw - 1]) << raw;
  for (std::size_t raw = 1085; raw < table.size(); ++raw) EXPECT_EQ(table[raw], 0) << raw << " is behind infinity";
}

TEST(KinectDepth, HasNoRawValueForNoReading) {
  for (const double z : {0.0, -1.0, std::nan(""), 0.2}) EXPECT_EQ(kinect_raw_of(z), kKinectNoReading) << z;
  EXPECT_EQ(kinect_depth_table()[kKinectNoReading], 0);
}

TEST(TickClock, GoesThroughTheWrap) {
  TickClock clock;
  EXPECT_EQ(clock.unwrap(0xFFFFFFE0U), Nanoseconds(0));
  EXPECT_EQ(clock.unwrap(0xFFFFFFF8U), Nanoseconds(400));
  EXPECT_EQ(clock.unwrap(0x00000010U), Nanoseconds(800)) << "48 ticks of 60 MHz";
  EXPECT_EQ(clock.unwrap(0x00000010U + 60'000'000U), Nanoseconds(1'000'000'800));
}

TEST(TickClock, NeverGoesBack) {
  TickClock clock;
  clock.unwrap(2'000'000);
  const Nanoseconds before = clock.unwrap(4'000'000);
  EXPECT_EQ(clock.unwrap(1'000'000), before + Nanoseconds(1)) << "a step back stands almost still";
  EXPECT_GT(clock.unwrap(2'000'000), before + Nanoseconds(1));
}

TEST(RegisterColor, ShiftsByTheParallax) {
  const CameraModel camera = default_kinect_camera();
  DepthImage depth{Image<std::uint16_t>(640, 480, 1050), 0.001};
  depth.pixels.at(7, 9) = 0;
  Image<Rgb8> color(640, 480);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) color.at(u, v) = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 1};
  EXPECT_EQ(register_color(depth, camera, color, camera, 0).at(100, 50), color.at(100, 50)) << "cameras in one place see the same";
  EXPECT_EQ(register_color(depth, camera, color, camera, 0).at(7, 9), Rgb8{}) << "no reading, no colour";
  EXPECT_EQ(register_color(depth, camera, color, camera, 0.02).at(200, 50), color.at(190, 50)) << "525 px * 20 mm / 1.05 m = 10 px";
}

}  // namespace
}  // namespace gfp
