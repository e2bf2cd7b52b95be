// The real libfreenect interface without hardware: fakenect plays folders that are made here from the synthetic source.
#include "freenect/freenect_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "gfp/frame/run_source.hpp"
#include "replay/replay_source.hpp"
#include "support/fakenect_folder.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class FakenectFolder : public ::testing::Test {
 protected:
  FakenectFolder() : folder(fs::path(::testing::TempDir()) / ("fakenect_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(folder);
    SyntheticOptions synthetic;
    synthetic.rate_hz = 0;
    synthetic.frames = 3;
    synthetic.frame_time = true;
    synthetic.motion = "orbit";
    SyntheticSource source(synthetic);
    EXPECT_TRUE(source.open());
    for (auto frame = source.grab(1s); frame; frame = source.grab(1s)) frames.push_back(std::move(*frame));
    test::write_fakenect_folder(folder, frames, 0xFFFFFF00U);  // the device's clock wraps at once
    options.folder = folder.string();
    options.color_offset_m = 0;  // the virtual Kinect has its two cameras in one place
    options.camera = CameraFile{default_kinect_camera(), {}, Transform::Identity()};
  }
  ~FakenectFolder() override { fs::remove_all(folder); }

  fs::path folder;
  std::vector<Frame> frames;
  FreenectOptions options;
};

TEST_F(FakenectFolder, PlaysThroughLibfreenectAndRewinds) {
  const auto source = make_freenect_source(options);
  EXPECT_TRUE(source->info().finite);
  Nanoseconds last{-1};
  for (std::uint64_t pass = 0; pass < 2; ++pass) {
    const auto opened = source->open();
    ASSERT_TRUE(opened) << opened.error().what;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto frame = source->grab(5s);
      ASSERT_TRUE(frame) << frame.error().what;
      EXPECT_EQ(frame->sequence, frames.size() * pass + i);
      EXPECT_GT(frame->stamps.sensor, last);
      if (i > 0) { EXPECT_NEAR(static_cast<double>((frame->stamps.sensor - last).count()), 1e9 / 30, 100) << "two ticks"; }
      last = frame->stamps.sensor;
      const KinectDepthTable table = kinect_depth_table();
      const Image<std::uint16_t> raw = test::raw_of(frames[i].depth);
      for (std::size_t p = 0; p < raw.pixels.size(); ++p) ASSERT_EQ(frame->depth.pixels.pixels[p], table[raw.pixels[p]]) << p;
      ASSERT_FALSE(frame->color.empty());
      EXPECT_EQ(frame->color.at(320, 400), frames[i].color.at(320, 400));
      EXPECT_EQ(frame->camera, default_kinect_camera());
    }
    EXPECT_EQ(source->grab(1s).error().code, ErrorCode::kEndOfStream);
    source->close();
    source->close();  // idempotent
  }
}

TEST_F(FakenectFolder, RunsAsAnyOtherSource) {
  const auto source = make_freenect_source(options);
  LatestSlot<FramePtr> slot;
  const SourceStatus status = run_source(*source, slot, {}, {});
  EXPECT_EQ(status.state, SourceState::kEnded);
  EXPECT_EQ(status.frames, frames.size());
}

TEST_F(FakenectFolder, ReadByReplayGivesTheSameDepth) {
  ReplayOptions replay;
  replay.rate_hz = 0;
  replay.camera = options.camera;
  const auto source = open_replay(folder, replay);
  ASSERT_TRUE(source) << source.error().what;
  ASSERT_TRUE((*source)->open());
  const auto frame = (*source)->grab(1s);
  ASSERT_TRUE(frame) << frame.error().what;
  EXPECT_EQ((*source)->frames(), frames.size());
  EXPECT_EQ(frame->color.pixels, frames[0].color.pixels);
  const auto live = make_freenect_source(options);
  ASSERT_TRUE(live->open());
  EXPECT_EQ(live->grab(5s)->depth.pixels.pixels, frame->depth.pixels.pixels);
}

// fakenect would end the process over each of these.
TEST_F(FakenectFolder, SaysWhatIsWrongWithIt) {
  options.depth = "mm";
  EXPECT_EQ(make_freenect_source(options)->open().error().code, ErrorCode::kInvalidArgument);
  options.depth = "raw";
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".pgm") fs::resize_file(entry.path(), 100);
  EXPECT_EQ(make_freenect_source(options)->open().error().code, ErrorCode::kCorruptData);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".pgm") fs::remove(entry.path());
  EXPECT_EQ(make_freenect_source(options)->open().error().code, ErrorCode::kNotFound);
  std::ofstream(folder / "INDEX.txt") << "../../etc/passwd\n";
  EXPECT_EQ(make_freenect_source(options)->open().error().code, ErrorCode::kCorruptData);
  options.folder = (folder / "nowhere").string();
  EXPECT_EQ(make_freenect_source(options)->open().error().code, ErrorCode::kNotFound);
}

TEST_F(FakenectFolder, PlaysAloneInItsProcess) {
  const auto first = make_freenect_source(options), second = make_freenect_source(options);
  ASSERT_TRUE(first->open());
  EXPECT_EQ(second->open().error().code, ErrorCode::kUnsupported);
  first->close();
  EXPECT_TRUE(second->open());
}

TEST(FreenectSource, WithoutADeviceIsLostNotBroken) {
  FreenectOptions options;
  options.serial = "no such Kinect";
  const auto source = make_freenect_source(options);
  const auto opened = source->open();
  ASSERT_FALSE(opened);
  if (opened.error().code == ErrorCode::kUnsupported) GTEST_SKIP() << opened.error().what;
  EXPECT_EQ(opened.error().code, ErrorCode::kDeviceLost) << "may come later: run_source tries again";
  EXPECT_EQ(source->grab(1ms).error().code, ErrorCode::kDeviceLost);
}

TEST(FreenectSource, NamesALibraryThatIsNotThere) {
  FreenectOptions options;
  options.library = "libnothing.so.7";
  EXPECT_EQ(make_freenect_source(options)->open().error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace gfp
