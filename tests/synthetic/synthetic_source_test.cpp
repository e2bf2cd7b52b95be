#include "synthetic/synthetic_source.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gfp/frame/run_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

SyntheticOptions free_running() {
  SyntheticOptions options;
  options.rate_hz = 0;
  options.frames = 3;
  options.frame_time = true;
  return options;
}

std::vector<Frame> play(SyntheticSource& source) {
  std::vector<Frame> frames;
  EXPECT_TRUE(source.open().has_value());
  for (auto frame = source.grab(1s); frame; frame = source.grab(1s)) frames.push_back(std::move(*frame));
  return frames;
}

TEST(SyntheticSource, DeliversItsFramesThenEnds) {
  SyntheticSource source(free_running());
  EXPECT_TRUE(source.info().finite);
  const auto frames = play(source);
  ASSERT_EQ(frames.size(), 3U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, i);
    EXPECT_EQ(frames[i].stamps.sensor, Nanoseconds(std::llround(1e9 * static_cast<double>(i) / 30)));
    EXPECT_EQ(frames[i].stamps.monotonic, frames[i].stamps.sensor);
    EXPECT_EQ(frames[i].camera, default_kinect_camera());
    EXPECT_EQ(frames[i].color.width, 640);
    EXPECT_EQ(frames[i].depth.scale_m, 0.001);
  }
  EXPECT_EQ(source.grab(1s).error().code, ErrorCode::kEndOfStream);
}

TEST(SyntheticSource, EveryFrameIsAFunctionOfOptionsAndSequence) {
  SyntheticOptions options = free_running();
  options.motion = "orbit";
  SyntheticSource a(options), b(options);
  const auto first = play(a), second = play(b);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].depth.pixels.pixels, second[i].depth.pixels.pixels);
    EXPECT_EQ(first[i].color.pixels, second[i].color.pixels);
  }
  EXPECT_NE(first[0].depth.pixels.pixels, first[1].depth.pixels.pixels);
  options.seed = 2;
  SyntheticSource other(options);
  EXPECT_NE(play(other)[0].depth.pixels.pixels, first[0].depth.pixels.pixels);
}

TEST(SyntheticSource, TruthIsThatOfTheFrame) {
  SyntheticOptions options = free_running();
  options.motion = "orbit";
  options.orbit_period_s = 2;
  options.camera.noise_scale = 0;
  SyntheticSource source(options);
  const auto frames = play(source);
  for (const Frame& frame : frames) {
    const FrameTruth truth = source.truth(frame.sequence);
    EXPECT_TRUE(truth.T_world_camera.isApprox(frame.T_world_sensor, 1e-12));
    EXPECT_EQ(truth.T_camera_object.size(), source.scene().objects.size());
    for (std::size_t i = 0; i < truth.depth_m.pixels.size(); ++i)
      ASSERT_NEAR(truth.depth_m.pixels[i], frame.depth.pixels.pixels[i] * frame.depth.scale_m, 1e-4);
  }
  EXPECT_FALSE(frames[0].T_world_sensor.isApprox(frames[2].T_world_sensor, 1e-3));  // it moves
}

TEST(SyntheticSource, EveryObjectIsInTheFirstPicture) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SyntheticOptions options = free_running();
    options.seed = seed;
    const FrameTruth truth = SyntheticSource(options).truth(0);
    for (int object = 0; object < options.table.objects; ++object)
      EXPECT_GT(std::count(truth.labels.pixels.begin(), truth.labels.pixels.end(), object), 100) << "seed " << seed << ", object " << object;
  }
}

TEST(SyntheticSource, RunsBehindTheRunner) {
  SyntheticSource source(free_running());
  LatestSlot<FramePtr> slot;
  const SourceStatus status = run_source(source, slot, {}, {});
  EXPECT_EQ(status.state, SourceState::kEnded);
  EXPECT_EQ(status.frames, 3U);
  EXPECT_EQ(slot.dropped(), 2U);
}

TEST(SyntheticSource, IsNotDueYetWithinAShortTimeout) {
  SyntheticOptions options;
  options.rate_hz = 0.001;
  SyntheticSource source(options);
  ASSERT_TRUE(source.open().has_value());
  EXPECT_TRUE(source.grab(1ms).has_value());
  EXPECT_EQ(source.grab(1ms).error().code, ErrorCode::kTimeout);
}

TEST(SyntheticSource, OpenSaysWhichOptionIsBad) {
  const auto error = [](auto change) {
    SyntheticOptions options;
    change(options);
    return SyntheticSource(options).open().error();
  };
  EXPECT_EQ(error([](SyntheticOptions& o) { o.distance_m = 0.1; }).what, "synthetic.distance_m = 0.1, expected [0.3, 5]");
  EXPECT_EQ(error([](SyntheticOptions& o) { o.motion = "jump"; }).what, "synthetic.motion = jump, expected static or orbit");
  EXPECT_EQ(error([](SyntheticOptions& o) { o.table.classes = {"unicorn"}; }).code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace gfp
