// The real OpenNI2 without hardware: its API, our driver that serves the synthetic source, its recorder and its player.
#include "openni2/openni2_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "gfp/frame/run_source.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

OpenNi2Options options_for(const std::string& uri) {
  OpenNi2Options options;
  options.library = GFP_OPENNI2_LIBRARY;
  options.uri = uri;
  return options;
}

std::vector<Frame> synthetic_frames(std::size_t count) {
  SyntheticOptions synthetic;
  synthetic.rate_hz = 0;
  synthetic.frames = count;
  synthetic.frame_time = true;
  SyntheticSource source(synthetic);
  EXPECT_TRUE(source.open());
  std::vector<Frame> frames;
  for (auto frame = source.grab(1s); frame; frame = source.grab(1s)) frames.push_back(std::move(*frame));
  return frames;
}

TEST(OpenNi2, ListsTheDeviceOfOurDriver) {
  const auto devices = list_openni2_devices(GFP_OPENNI2_LIBRARY);
  ASSERT_TRUE(devices) << devices.error().what;
  ASSERT_EQ(devices->size(), 1U);
  EXPECT_EQ(devices->front().uri, "gfp-synthetic");
}

// Frame n of the device is frame n of the synthetic source, whichever the application gets to see first.
TEST(OpenNi2, DeliversTheSyntheticSourceLive) {
  const auto expected = synthetic_frames(12);
  const auto source = make_openni2_source(options_for("gfp-synthetic"));
  const auto opened = source->open();
  ASSERT_TRUE(opened) << opened.error().what;
  Nanoseconds last{-1};
  std::size_t found = 0;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const auto frame = source->grab(10s);
    ASSERT_TRUE(frame) << frame.error().what;
    EXPECT_EQ(frame->sequence, i);
    EXPECT_GT(frame->stamps.sensor, last);
    last = frame->stamps.sensor;
    EXPECT_NEAR(frame->camera.fx, 525, 0.01);
    EXPECT_NEAR(frame->camera.fy, 525, 0.01);
    ASSERT_EQ(frame->color.width, 640);
    for (const Frame& candidate : expected)
      if (frame->depth.pixels.pixels == candidate.depth.pixels.pixels) ++found;
  }
  EXPECT_GE(found, 1U) << "a busy machine may skip beyond the twelfth frame";
  source->close();
  source->close();
  EXPECT_EQ(source->grab(1ms).error().code, ErrorCode::kDeviceLost);
}

TEST(OpenNi2, RecordsAndReplaysWithoutLoss) {
  const fs::path file = fs::path(::testing::TempDir()) / "openni2_replay.oni";
  fs::remove(file);
  std::vector<Frame> live;
  {
    OpenNi2Options options = options_for("gfp-synthetic:rate_hz=10");
    options.record = file.string();
    const auto source = make_openni2_source(options);
    const auto opened = source->open();
    ASSERT_TRUE(opened) << opened.error().what;
    for (int i = 0; i < 4; ++i) {
      auto frame = source->grab(10s);
      ASSERT_TRUE(frame) << frame.error().what;
      live.push_back(std::move(*frame));
    }
  }
  OpenNi2Options options = options_for(file.string());
  options.fast = options.frame_time = true;
  const auto player = make_openni2_source(options);
  ASSERT_TRUE(player->info().finite);
  std::vector<Frame> replayed;
  for (int pass = 0; pass < 2; ++pass) {
    const auto opened = player->open();
    ASSERT_TRUE(opened) << opened.error().what;
    replayed.clear();
    auto frame = player->grab(10s);
    for (; frame; frame = player->grab(10s)) replayed.push_back(std::move(*frame));
    ASSERT_EQ(frame.error().code, ErrorCode::kEndOfStream) << frame.error().what;
    ASSERT_GE(replayed.size(), 3U);
    player->close();
  }
  std::size_t same = 0;
  for (const Frame& a : live)
    for (const Frame& b : replayed) same += a.depth.pixels.pixels == b.depth.pixels.pixels ? 1 : 0;
  EXPECT_GE(same, 3U);
  EXPECT_NEAR(replayed[0].camera.fx, 525, 0.01);
  EXPECT_EQ(replayed[1].stamps.monotonic, replayed[1].stamps.sensor);

  options.first_frame = 2;
  const auto later = make_openni2_source(options);
  ASSERT_TRUE(later->open());
  const auto frame = later->grab(10s);
  ASSERT_TRUE(frame) << frame.error().what;
  EXPECT_EQ(frame->depth.pixels.pixels, replayed[2].depth.pixels.pixels) << "our own index";
  fs::remove(file);
}

TEST(OpenNi2, ComesBackAfterItWasUnplugged) {
  const auto source = make_openni2_source(options_for("gfp-synthetic:unplug_after=2"));
  LatestSlot<FramePtr> slot;
  std::stop_source stop;
  SourceOptions options;
  options.reconnect.initial_s = 0.01;
  int lost = 0;
  const SourceStatus last = run_source(*source, slot, options, stop.get_token(), [&](const SourceStatus& status) {
    lost += status.state == SourceState::kLost ? 1 : 0;
    if (status.reconnects >= 3) stop.request_stop();
  });
  EXPECT_EQ(last.state, SourceState::kStopped);
  EXPECT_GE(last.reconnects, 3U);
  EXPECT_GE(lost, 3);
}

TEST(OpenNi2, SaysWhatIsWrong) {
  EXPECT_EQ(make_openni2_source(options_for("nothing.oni"))->open().error().code, ErrorCode::kNotFound);
  EXPECT_EQ(make_openni2_source(options_for("gfp-synthetic:colour=green"))->open().error().code, ErrorCode::kDeviceLost);
  const fs::path junk = fs::path(::testing::TempDir()) / "openni2_junk.oni";
  std::ofstream(junk) << "not a recording";
  EXPECT_EQ(make_openni2_source(options_for(junk.string()))->open().error().code, ErrorCode::kCorruptData);
  fs::remove(junk);
  OpenNi2Options options;
  options.library = "libnothing.so.7";
  EXPECT_EQ(make_openni2_source(options)->open().error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace gfp
