#include "replay/replay_source.hpp"

#include <gtest/gtest.h>

#include "gfp/frame/png.hpp"
#include "gfp/frame/run_source.hpp"
#include "replay/files.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::TemporaryFolder;

ReplayOptions free_running() {
  ReplayOptions options;
  options.rate_hz = 0;
  options.frame_time = true;
  return options;
}

Image<std::uint16_t> constant(std::uint16_t value) { return Image<std::uint16_t>(8, 6, value); }

void write_depth(const TemporaryFolder& folder, const char* name, std::uint16_t value) {
  std::filesystem::create_directories((folder / name).parent_path());
  ASSERT_TRUE(write_png(folder / name, constant(value)).has_value());
}

std::vector<Frame> play(ReplaySource& source, std::size_t at_most = 100) {
  std::vector<Frame> frames;
  EXPECT_TRUE(source.open().has_value());
  while (frames.size() < at_most) {
    auto frame = source.grab(1s);
    if (!frame && frame.error().code == ErrorCode::kEndOfStream) break;
    if (frame) frames.push_back(std::move(*frame));
  }
  return frames;
}

std::vector<int> depths(const std::vector<Frame>& frames) {
  std::vector<int> values;
  for (const Frame& frame : frames) values.push_back(frame.depth.pixels.at(3, 3));
  return values;
}

TEST(ReplaySource, PlaysAFolderInNameOrderWithItsColour) {
  const TemporaryFolder folder;
  write_depth(folder, "0002-depth.png", 2);
  write_depth(folder, "0001-depth.png", 1);
  write_depth(folder, "0001-other.png", 77);
  ASSERT_TRUE(write_png(folder / "0001-color.png", Image<Rgb8>(8, 6, Rgb8{1, 2, 3})).has_value());
  auto source = open_replay(folder.path(), free_running());
  ASSERT_TRUE(source.has_value()) << source.error().what;
  const auto frames = play(**source);
  EXPECT_EQ(depths(frames), (std::vector<int>{1, 2}));
  EXPECT_EQ(frames[0].color.at(0, 0), (Rgb8{1, 2, 3}));
  EXPECT_TRUE(frames[1].color.empty());
  EXPECT_EQ(frames[1].sequence, 1U);
  EXPECT_EQ(frames[1].stamps.sensor - frames[0].stamps.sensor, Nanoseconds(33'333'333));
  EXPECT_EQ(frames[1].stamps.monotonic, frames[1].stamps.sensor);  // no clock was read
}

TEST(ReplaySource, StepTakesEveryNthAndLoopKeepsTimeRising) {
  const TemporaryFolder folder;
  for (int i = 0; i < 5; ++i) write_depth(folder, ("f" + std::to_string(i) + ".png").c_str(), static_cast<std::uint16_t>(i + 1));
  ReplayOptions options = free_running();
  options.step = 2;
  options.loop = true;
  auto source = open_replay(folder.path(), options);
  ASSERT_TRUE(source.has_value()) << source.error().what;
  EXPECT_FALSE((*source)->info().finite);
  const auto frames = play(**source, 7);
  EXPECT_EQ(depths(frames), (std::vector<int>{1, 3, 5, 1, 3, 5, 1}));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, i);
    EXPECT_EQ(frames[i].stamps.sensor - frames[i - 1].stamps.sensor, Nanoseconds(33'333'333)) << i;
  }
}

TEST(ReplaySource, AssumesAKinectAndSaysSo) {
  const TemporaryFolder folder;
  write_depth(folder, "only.png", 900);
  auto source = open_replay(folder / "only.png", free_running());
  ASSERT_EQ(play(**source).size(), 1U);
  EXPECT_EQ((*source)->report().camera_origin, CameraOrigin::kAssumed);
  ASSERT_EQ((*source)->report().notes.size(), 1U);
  EXPECT_NE((*source)->report().notes[0].find("assuming a Kinect"), std::string::npos);
}

TEST(ReplaySource, TakesCameraAndScaleFromTheOptions) {
  const TemporaryFolder folder;
  write_depth(folder, "only.png", 900);
  ReplayOptions options = free_running();
  options.camera = parse_inline_camera("100,101,4,3").value();
  options.camera->depth_scale_m = 0.0001;
  auto source = open_replay(folder.path(), options);
  const auto frames = play(**source);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].camera, (CameraModel{8, 6, 100, 101, 4, 3, DistortionModel::kNone, {}}));
  EXPECT_EQ(frames[0].depth.scale_m, 0.0001);
  EXPECT_EQ((*source)->report().camera_origin, CameraOrigin::kGiven);

  options.depth_scale_m = 7;
  auto bad = open_replay(folder.path(), options);
  EXPECT_EQ((*bad)->grab(1s).error().code, ErrorCode::kInvalidArgument);
  options.depth_scale_m = 0.001;
  options.camera->camera.width = 640, options.camera->camera.height = 480;
  auto other_size = open_replay(folder.path(), options);
  const auto frame = (*other_size)->grab(1s);
  ASSERT_FALSE(frame.has_value());
  EXPECT_NE(frame.error().what.find("only.png: camera is 640 x 480, expected the image's 8 x 6"), std::string::npos) << frame.error().what;
}

TEST(ReplaySource, ABadFileCostsOneFrame) {
  const TemporaryFolder folder;
  write_depth(folder, "a.png", 1);
  write_depth(folder, "c.png", 3);
  folder.write("b.pcd", "nonsense\n");
  auto source = open_replay(folder.path(), free_running());
  LatestSlot<FramePtr> slot;
  const SourceStatus status = run_source(**source, slot, {}, {});
  EXPECT_EQ(status.state, SourceState::kEnded);
  EXPECT_EQ(status.frames, 2U);
  EXPECT_EQ(status.corrupt_frames, 1U);
  EXPECT_NE(status.last_error->what.find("recording"), std::string::npos);
}

TEST(ReplaySource, ReadsPclzfFramesWithTheirCalibrationAndPrefersThemToTheCloud) {
  const TemporaryFolder folder;
  folder.write("frame_20121214T142255.814212_depth.pclzf", test::depth_pclzf(constant(1234)));
  folder.write("frame_20121214T142255.814212_rgb.pclzf", test::pclzf(8, 6, "rgb24", std::string(144, 'c')));
  folder.write("frame_20121214T142255.814212.xml", test::kPclzfXml);
  folder.write("frame_20121214T142255.814212.pcd", "the same capture again");
  auto source = open_replay(folder.path(), free_running());
  const auto frames = play(**source);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(depths(frames), std::vector<int>{1234});
  EXPECT_EQ(frames[0].camera.fy, 526);
  EXPECT_EQ(frames[0].camera.width, 8);
  EXPECT_EQ(frames[0].color.at(1, 1), (Rgb8{'c', 'c', 'c'}));
  EXPECT_EQ(frames[0].stamps.sensor, Nanoseconds(1355494975'814212000));  // 2012-12-14 14:22:55.814212 UTC
  EXPECT_EQ((*source)->report().camera_origin, CameraOrigin::kFile);
}

TEST(ReplaySource, TurnsCloudsIntoDepthAndReportsAxesAndViewpoint) {
  const TemporaryFolder folder;
  const CameraModel camera{64, 48, 70, 71, 31.5, 23.5, DistortionModel::kNone, {}};
  std::string bytes = test::compressed_pcd(test::draw_wall(camera, parse_axes("x-y-z").value()));
  bytes.replace(bytes.find("VIEWPOINT 0 0 0 1"), 17, "VIEWPOINT 0 0 0 0");
  auto source = open_replay(folder.write("gl.pcd", bytes), free_running());
  const auto frames = play(**source);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ((*source)->report().axes, "x-y-z");
  EXPECT_EQ((*source)->report().camera_origin, CameraOrigin::kFitted);
  EXPECT_EQ((*source)->report().notes.size(), 2U);
  EXPECT_NEAR(frames[0].camera.fx, 70, 1e-3);
  EXPECT_EQ(frames[0].depth.scale_m, 1e-4);
  EXPECT_NEAR(frames[0].depth.pixels.at(32, 24) * 1e-4, 0.8 + 0.1 + 0.05, 0.5e-4 + 1e-6);
  EXPECT_EQ(frames[0].depth.pixels.at(7, 5), 0);  // the hole
}

TEST(ReplaySource, PlaysTumFoldersByListAndByFolder) {
  const TemporaryFolder folder;
  write_depth(folder, "depth/1305031102.160407.png", 5000);
  write_depth(folder, "depth/1305031102.194330.png", 5001);
  std::filesystem::create_directories(folder / "rgb");
  ASSERT_TRUE(write_png(folder / "rgb" / "1305031102.175304.png", Image<Rgb8>(8, 6, Rgb8{9, 9, 9})).has_value());
  const auto check = [&](const char* what) {
    auto source = open_replay(folder.path(), free_running());
    ASSERT_TRUE(source.has_value()) << what << ": " << source.error().what;
    const auto frames = play(**source);
    ASSERT_EQ(depths(frames), (std::vector<int>{5000, 5001})) << what;
    EXPECT_EQ(frames[0].depth.scale_m, 1.0 / 5000) << what;
    EXPECT_EQ(frames[0].stamps.sensor, Nanoseconds(1305031102'160407000)) << what;
    EXPECT_FALSE(frames[0].color.empty()) << what;   // 14.9 ms away
    EXPECT_FALSE(frames[1].color.empty()) << what;   // 19.0 ms away
  };
  check("folders");
  folder.write("depth.txt", "# depth maps\n# timestamp filename\n1305031102.194330 depth/1305031102.194330.png\n1305031102.160407 depth/1305031102.160407.png\n");
  folder.write("rgb.txt", "1305031102.175304 rgb/1305031102.175304.png\n");
  check("lists");
  folder.write("associations.txt",
               "1305031102.160407 depth/1305031102.160407.png 1305031102.175304 rgb/1305031102.175304.png\n"
               "1305031102.175304 rgb/1305031102.175304.png 1305031102.194330 depth/1305031102.194330.png\n");
  check("associations");
}

TEST(ReplaySource, TumListsCannotLeaveTheirFolder) {
  for (const char* file : {"/etc/passwd", "../secret.png", "depth/../../secret.png"}) {
    const TemporaryFolder folder;
    folder.write("depth.txt", std::string("1305031102.16 ") + file + "\n");
    const auto source = open_replay(folder.path(), free_running());
    ASSERT_FALSE(source.has_value()) << file;
    EXPECT_EQ(source.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(source.error().what.find("depth.txt:1: file"), std::string::npos) << source.error().what;
  }
}

TEST(ReplaySource, SaysWhyItCannotOpen) {
  const TemporaryFolder folder;
  EXPECT_EQ(open_replay(folder / "absent").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(open_replay(folder.path()).error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(open_replay(folder.write("a.mcap", "\x89MCAP0\r\n")).error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(open_replay(folder.write("depth.txt", "yesterday depth/a.png\n").parent_path()).error().code, ErrorCode::kCorruptData);
  const auto with = [&](auto change) {
    ReplayOptions options;
    change(options);
    return open_replay(folder.write("x.pcd", ""), options).error();
  };
  EXPECT_EQ(with([](ReplayOptions& o) { o.step = 0; }).what, "replay.step = 0, expected at least 1");
  EXPECT_EQ(with([](ReplayOptions& o) { o.rate_hz = -1; }).what, "replay.rate_hz = -1, expected [0, 1000]");
  EXPECT_EQ(with([](ReplayOptions& o) { o.axes = "up"; }).code, ErrorCode::kInvalidArgument);
}

TEST(ReplaySource, IsNotDueYetWithinAShortTimeout) {
  const TemporaryFolder folder;
  write_depth(folder, "a.png", 1);
  write_depth(folder, "b.png", 2);
  ReplayOptions options;
  options.rate_hz = 0.001;
  auto source = open_replay(folder.path(), options);
  ASSERT_TRUE((*source)->open().has_value());
  EXPECT_TRUE((*source)->grab(1ms).has_value());
  EXPECT_EQ((*source)->grab(1ms).error().code, ErrorCode::kTimeout);
}

TEST(StampFromName, ReadsBothFormsOnly) {
  EXPECT_EQ(stamp_from_name("1.5"), Nanoseconds(1'500'000'000));
  EXPECT_EQ(stamp_from_name("frame_19700102T000001.000001"), Nanoseconds(86'401'000'001'000));
  for (const char* none : {"", "000001", "learn3", "1.", ".5", "-1.5", "frame_20121314T142255.8", "frame_20121214T252255.8", "99999999999.1"})
    EXPECT_FALSE(stamp_from_name(none).has_value()) << none;
}

TEST(QuantiseDepth, LosesNothingAKinectMeasures) {
  const DepthImage near = quantise_depth(2, 2, {0.8001F, 6.5F, std::nanf(""), -1.0F});
  EXPECT_EQ(near.scale_m, 1e-4);
  EXPECT_EQ(near.pixels.pixels, (std::vector<std::uint16_t>{8001, 65000, 0, 0}));
  const DepthImage far = quantise_depth(2, 1, {0.8F, 10.0F});
  EXPECT_EQ(far.scale_m, 2e-4);
  EXPECT_EQ(far.pixels.pixels, (std::vector<std::uint16_t>{4000, 50000}));
  const DepthImage beyond = quantise_depth(3, 1, {0.8F, 65.5F, 1000.0F});
  EXPECT_EQ(beyond.scale_m, 1e-3);
  EXPECT_EQ(beyond.pixels.pixels, (std::vector<std::uint16_t>{800, 65500, 0}));
}

}  // namespace
}  // namespace gfp
