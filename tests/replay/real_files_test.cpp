#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "replay/pcd.hpp"
#include "replay/pclzf.hpp"
#include "replay/replay_source.hpp"
#include "support/data_folder.hpp"

// The recordings' own descriptions say which intrinsics, axes and values must come out.

namespace gfp {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

ReplayOptions free_running() {
  ReplayOptions options;
  options.rate_hz = 0;
  options.frame_time = true;
  return options;
}

struct Played {
  std::vector<Frame> frames;
  std::vector<FrameReport> reports;
};

Played play(const fs::path& input, const ReplayOptions& options = free_running()) {
  auto source = open_replay(input, options);
  if (!source) {
    ADD_FAILURE() << source.error().what;
    return {};
  }
  Played played;
  EXPECT_TRUE((*source)->open().has_value());
  while (true) {
    auto frame = (*source)->grab(1s);
    if (!frame) {
      EXPECT_EQ(frame.error().code, ErrorCode::kEndOfStream) << frame.error().what;
      return played;
    }
    played.frames.push_back(std::move(*frame));
    played.reports.push_back((*source)->report());
  }
}

void expect_camera(const CameraModel& camera, double fx, double fy, double cx, double cy, double tolerance_px) {
  EXPECT_NEAR(camera.fx, fx, tolerance_px);
  EXPECT_NEAR(camera.fy, fy, tolerance_px);
  EXPECT_NEAR(camera.cx, cx, tolerance_px);
  EXPECT_NEAR(camera.cy, cy, tolerance_px);
}

double valid_share(const Frame& frame) {
  const auto& pixels = frame.depth.pixels.pixels;
  return 1.0 - static_cast<double>(std::count(pixels.begin(), pixels.end(), 0)) / static_cast<double>(pixels.size());
}

double median_depth_m(const Frame& frame) {
  std::vector<std::uint16_t> readings;
  for (const std::uint16_t value : frame.depth.pixels.pixels)
    if (value > 0) readings.push_back(value);
  std::nth_element(readings.begin(), readings.begin() + static_cast<std::ptrdiff_t>(readings.size() / 2), readings.end());
  return readings[readings.size() / 2] * frame.depth.scale_m;
}

TEST(RealFiles, OsdLearnIsAnExactKinect) {
  const fs::path folder = test::data_folder() / "scenes" / "osd_learn";
  GFP_SKIP_WITHOUT(folder);
  const Played played = play(folder);
  ASSERT_EQ(played.frames.size(), 11U);
  for (std::size_t i = 0; i < played.frames.size(); ++i) {
    expect_camera(played.frames[i].camera, 525, 525, 319.5, 239.5, 1e-3);
    EXPECT_EQ(played.reports[i].axes, "xyz");
    EXPECT_LT(played.reports[i].pinhole_rms_px, 1e-3);
    EXPECT_EQ(played.frames[i].color.width, 640);
    EXPECT_GT(valid_share(played.frames[i]), 0.54);  // 33 to 46 % of the pixels were cropped away
    EXPECT_LT(valid_share(played.frames[i]), 0.68);
  }
}

TEST(RealFiles, OsdLearnHasLabelsWhereItHasPoints) {
  const fs::path file = test::data_folder() / "scenes" / "osd_learn" / "learn3.pcd";
  GFP_SKIP_WITHOUT(file);
  const auto labels = read_pcd_labels(file);
  ASSERT_TRUE(labels.has_value()) << labels.error().what;
  std::set<std::uint32_t> objects;
  for (const std::uint32_t label : labels->pixels)
    if (label >= 20) objects.insert(label / 10);
  EXPECT_GE(objects.size(), 2U);
  EXPECT_LE(objects.size(), 8U);
}

TEST(RealFiles, StereoMugHasItsLongLens) {
  const fs::path folder = test::data_folder() / "scenes" / "pcl_stereo_mug";
  GFP_SKIP_WITHOUT(folder);
  const Played played = play(folder);
  ASSERT_EQ(played.frames.size(), 1U);
  expect_camera(played.frames[0].camera, 964.36, 964.36, 319.81, 223.36, 0.1);
  EXPECT_NEAR(valid_share(played.frames[0]), 1 - 0.319, 0.001);
  EXPECT_EQ(played.reports[0].notes.size(), 1U);  // its VIEWPOINT is odd
}

TEST(RealFiles, MilkBottlesAreTurnedIntoTheOpticalFrame) {
  const fs::path folder = test::data_folder() / "scenes" / "pcl_milk_bottles";
  GFP_SKIP_WITHOUT(folder);
  const Played played = play(folder / "milk_cartoon_all_small_clorox.pcd");
  ASSERT_EQ(played.frames.size(), 1U);
  EXPECT_EQ(played.reports[0].axes, "x-y-z");
  expect_camera(played.frames[0].camera, 525, 525, 319.5, 239.5, 1e-2);
  EXPECT_NEAR(valid_share(played.frames[0]), 1 - 0.214, 0.001);
  ReplayOptions told = free_running();
  told.axes = "x-y-z";
  EXPECT_EQ(play(folder / "milk_cartoon_all_small_clorox.pcd", told).frames[0].depth.pixels.pixels, played.frames[0].depth.pixels.pixels);
}

TEST(RealFiles, UnorganisedMilkIsRefusedClearly) {
  const fs::path file = test::data_folder() / "scenes" / "pcl_milk_bottles" / "milk.pcd";
  GFP_SKIP_WITHOUT(file);
  auto source = open_replay(file, free_running());
  const auto frame = (*source)->grab(1s);
  ASSERT_FALSE(frame.has_value());
  EXPECT_EQ(frame.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(frame.error().what.find("unorganised (12575 x 1)"), std::string::npos) << frame.error().what;
}

TEST(RealFiles, BottlePackIsAnExactKinect) {
  const fs::path folder = test::data_folder() / "scenes" / "pcl_bottle_pack";
  GFP_SKIP_WITHOUT(folder);
  const Played played = play(folder);
  ASSERT_EQ(played.frames.size(), 1U);
  expect_camera(played.frames[0].camera, 525, 525, 320, 240, 1e-2);
  EXPECT_NEAR(valid_share(played.frames[0]), 1 - 0.154, 0.001);
}

TEST(RealFiles, GrabberSequencePlaysWithItsStampsAndEqualsTheCloud) {
  const fs::path folder = test::data_folder() / "recordings" / "pcl_grabber_sequence";
  GFP_SKIP_WITHOUT(folder);
  const Played played = play(folder);
  ASSERT_EQ(played.frames.size(), 3U);  // the first is there twice, as pclzf and as pcd
  expect_camera(played.frames[0].camera, 525, 525, 320, 240, 0);
  EXPECT_EQ(played.frames[1].stamps.sensor - played.frames[0].stamps.sensor, Nanoseconds(254'471'000));
  EXPECT_EQ(played.frames[0].color.width, 640);

  const Played cloud = play(folder / "frame_20121214T142255.814212.pcd");
  ASSERT_EQ(cloud.frames.size(), 1U);
  expect_camera(cloud.frames[0].camera, 525, 525, 320, 240, 1e-2);
  const auto& mm = played.frames[0].depth.pixels.pixels;
  const auto& fine = cloud.frames[0].depth;
  ASSERT_EQ(fine.scale_m, 1e-4);
  for (std::size_t i = 0; i < mm.size(); ++i) ASSERT_EQ(fine.pixels.pixels[i], 10 * mm[i]) << i;
}

TEST(RealFiles, YcbvFramesOpenWithTheirCamera) {
  const fs::path folder = test::data_folder() / "scenes" / "ycbv_mug_box_brick";
  GFP_SKIP_WITHOUT(folder);
  ReplayOptions options = free_running();
  options.camera = parse_inline_camera("1066.778,1067.487,312.9869,241.3109").value();
  options.depth_scale_m = 1e-4;
  const Played played = play(folder, options);
  ASSERT_EQ(played.frames.size(), 10U);
  for (const Frame& frame : played.frames) {
    EXPECT_EQ(frame.camera.fx, 1066.778);
    EXPECT_EQ(frame.color.width, 640);
    EXPECT_NEAR(median_depth_m(frame), 0.8, 0.3);  // a desk at arm's length
  }
}

}  // namespace
}  // namespace gfp
