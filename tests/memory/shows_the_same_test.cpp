#include <gtest/gtest.h>

#include <cmath>

#include "gfp/core/random.hpp"
#include "gfp/memory/associate.hpp"

namespace gfp {
namespace {

/// A table at 1 m with a block before it, as a Kinect reads it: 1 mm steps and the sensor's own noise.
Frame frame_of(const PixelRect& block, double block_m, std::uint64_t seed) {
  Frame frame;
  frame.sensor = "kinect";
  frame.camera = default_kinect_camera(160, 120);
  frame.depth.pixels = Image<std::uint16_t>(160, 120);
  Random random(seed);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const double depth_m = block.contains(u, v) ? block_m : 1.0;
      frame.depth.pixels.at(u, v) = static_cast<std::uint16_t>(std::lround(1000 * (depth_m + frame.noise.sigma_m(depth_m) * random.normal())));
    }
  }
  return frame;
}

constexpr PixelRect kBlock{40, 30, 80, 70};

TEST(ShowsTheSame, NoiseAloneIsNoChange) {
  const Frame before = frame_of(kBlock, 0.8, 1);
  for (std::uint64_t seed = 2; seed <= 40; ++seed) EXPECT_TRUE(shows_the_same(frame_of(kBlock, 0.8, seed), before)) << "seed " << seed;
}

TEST(ShowsTheSame, EdgesThatFlickerAreNoChange) {
  const Frame before = frame_of(kBlock, 0.8, 1);
  for (std::uint64_t seed = 2; seed <= 20; ++seed) {
    Frame now = frame_of(kBlock, 0.8, seed);
    Random random(seed);
    for (int v = kBlock.v0; v < kBlock.v1; ++v)
      if (random.uniform(0, 1) < 0.4) now.depth.pixels.at(kBlock.u0, v) = 1000;
    EXPECT_TRUE(shows_the_same(now, before)) << "seed " << seed;
  }
}

TEST(ShowsTheSame, SeesWhatMoved) {
  const Frame before = frame_of(kBlock, 0.8, 1);
  EXPECT_FALSE(shows_the_same(frame_of({42, 30, 82, 70}, 0.8, 2), before)) << "two pixels aside";
  EXPECT_FALSE(shows_the_same(frame_of({40, 32, 80, 72}, 0.8, 2), before)) << "two pixels down";
  EXPECT_FALSE(shows_the_same(frame_of(kBlock, 0.803, 2), before)) << "3 mm farther";
  EXPECT_FALSE(shows_the_same(frame_of({}, 0.8, 2), before)) << "gone";
}

TEST(ShowsTheSame, SeesTheLeastObjectThatSegmentationTakes) {
  const Frame before = frame_of({}, 0.8, 1);
  EXPECT_FALSE(shows_the_same(frame_of({99, 51, 119, 67}, 0.985, 2), before)) << "20 x 16 pixels, 15 mm high";
}

TEST(ShowsTheSame, SeesReadingsGo) {
  const Frame before = frame_of({}, 0.8, 1);
  Frame glass = frame_of({}, 0.8, 2);
  for (int v = 40; v < 64; ++v)
    for (int u = 40; u < 64; ++u) glass.depth.pixels.at(u, v) = 0;
  EXPECT_FALSE(shows_the_same(glass, before));
}

TEST(ShowsTheSame, AnotherStandpointIsAnotherScene) {
  const Frame before = frame_of(kBlock, 0.8, 1);
  Frame now = frame_of(kBlock, 0.8, 2);
  EXPECT_TRUE(shows_the_same(now, before));
  now.T_world_sensor.translation().x() = 0.001;
  EXPECT_FALSE(shows_the_same(now, before));
  now = frame_of(kBlock, 0.8, 2);
  now.sensor = "other";
  EXPECT_FALSE(shows_the_same(now, before));
  now = frame_of(kBlock, 0.8, 2);
  now.camera.fx += 1;
  EXPECT_FALSE(shows_the_same(now, before));
  now = frame_of(kBlock, 0.8, 2);
  now.mask = Image<std::uint8_t>(160, 120, 1);
  EXPECT_FALSE(shows_the_same(now, before));
}

TEST(ShowsTheSame, TakesImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair{0, 0}, std::pair{1, 1}, std::pair{13, 9}}) {
    Frame frame;
    frame.depth.pixels = Image<std::uint16_t>(width, height, 900);
    EXPECT_TRUE(shows_the_same(frame, frame));
  }
}

}  // namespace
}  // namespace gfp
