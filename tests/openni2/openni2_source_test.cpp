// The real OpenNI2 without hardware: its API, our driver that serves the synthetic source, its recorder and its player.
#include "openni2/openni2_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

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

/// OpenNI2's encoder writes what is left at a frame's end in the wrong order, which moves up to its last 31 pixels by some table steps (2.2.0.33).
bool same_pictures(const Frame& a, const Frame& b) {
  const auto &left = a.depth.pixels.pixels, &right = b.depth.pixels.pixels;
  return left.size() == right.size() && std::equal(left.begin(), left.end() - 31, right.begin());
}

/// All frames of a recording, as fast as they come.
std::vector<Frame> replay(const fs::path& file) {
  OpenNi2Options options = options_for(file.string());
  options.fast = options.frame_time = true;
  const auto player = make_openni2_source(options);
  EXPECT_TRUE(player->info().finite);
  const auto opened = player->open();
  EXPECT_TRUE(opened) << opened.error().what;
  std::vector<Frame> frames;
  auto frame = player->grab(10s);
  for (; frame; frame = player->grab(10s)) frames.push_back(std::move(*frame));
  EXPECT_EQ(frame.error().code, ErrorCode::kEndOfStream) << frame.error().what;
  return frames;
}

// A live sensor's frames may be missed by a busy machine. What was delivered while it was recorded is in the recording, in its order and with its distances
// in time, however often that is played.
TEST(OpenNi2, WhatWasDeliveredIsInTheRecording) {
  const fs::path file = fs::path(::testing::TempDir()) / "openni2_replay.oni";
  fs::remove(file);
  std::vector<Frame> live;
  {
    OpenNi2Options options = options_for("gfp-synthetic:rate_hz=20");
    options.record = file.string();
    const auto source = make_openni2_source(options);
    const auto opened = source->open();
    ASSERT_TRUE(opened) << opened.error().what;
    for (int i = 0; i < 8; ++i) {
      auto frame = source->grab(10s);
      ASSERT_TRUE(frame) << frame.error().what;
      live.push_back(std::move(*frame));
    }
  }
  const std::vector<Frame> replayed = replay(file), again = replay(file);
  ASSERT_EQ(again.size(), replayed.size());
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].depth.pixels.pixels, replayed[i].depth.pixels.pixels) << "frame " << i;
  auto at = replayed.begin();
  std::optional<Nanoseconds> shift;
  for (const Frame& frame : live) {
    at = std::find_if(at, replayed.end(), [&](const Frame& candidate) { return same_pictures(candidate, frame); });
    ASSERT_NE(at, replayed.end()) << "frame " << frame.sequence << " of " << live.size() << " was delivered, but is not in the recording of " << replayed.size();
    EXPECT_EQ(at->stamps.monotonic, at->stamps.sensor);
    EXPECT_EQ(at->color.pixels.size(), 640U * 480U);
    shift = shift.value_or(at->stamps.sensor - frame.stamps.sensor);
    EXPECT_EQ(at->stamps.sensor - frame.stamps.sensor, *shift) << "frame " << frame.sequence;
  }
  EXPECT_NEAR(replayed[0].camera.fx, 525, 0.01);

  OpenNi2Options options = options_for(file.string());
  options.fast = true;
  options.first_frame = 2;
  const auto later = make_openni2_source(options);
  ASSERT_TRUE(later->open());
  const auto frame = later->grab(10s);
  ASSERT_TRUE(frame) << frame.error().what;
  EXPECT_EQ(frame->depth.pixels.pixels, replayed[2].depth.pixels.pixels) << "our own index";
  fs::remove(file);
}

// In its own time a recording loses nothing either, and its rhythm is the recorded one.
TEST(OpenNi2, ARecordingPlayedInItsOwnTimeIsComplete) {
  const fs::path file = fs::path(::testing::TempDir()) / "openni2_paced.oni";
  fs::remove(file);
  {
    OpenNi2Options options = options_for("gfp-synthetic:rate_hz=20");
    options.record = file.string();
    const auto source = make_openni2_source(options);
    ASSERT_TRUE(source->open());
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(source->grab(10s));
  }
  const std::vector<Frame> all = replay(file);
  const auto player = make_openni2_source(options_for(file.string()));
  ASSERT_TRUE(player->open());
  std::size_t frames = 0, not_due = 0;
  Nanoseconds first{};
  while (frames < all.size()) {
    const auto frame = player->grab(10ms);
    if (!frame) {
      ASSERT_EQ(frame.error().code, ErrorCode::kTimeout) << frame.error().what;
      ++not_due;
      continue;
    }
    EXPECT_EQ(frame->depth.pixels.pixels, all[frames].depth.pixels.pixels) << "frame " << frames;
    if (frames++ == 0) first = frame->stamps.monotonic - frame->stamps.sensor;
    EXPECT_GE(frame->stamps.monotonic - frame->stamps.sensor, first) << "no frame comes before its time";
  }
  EXPECT_GE(not_due, 1U);
  EXPECT_EQ(player->grab(1s).error().code, ErrorCode::kEndOfStream);
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
