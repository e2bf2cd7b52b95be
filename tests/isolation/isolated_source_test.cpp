// Real driver processes of the real gfpd: what they deliver, and what happens when they crash or hang.
#include "app/isolated_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/make_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

SensorConfig sensor_with(const std::string& failure, std::uint64_t for_frames) {
  SensorConfig sensor;
  sensor.name = "far";
  sensor.synthetic.table.objects = 0;
  sensor.synthetic.camera.color = false;
  sensor.synthetic.rate_hz = 100;
  sensor.source.hang_s = failure == "hang" ? 4 : 30;  // a busy machine may not let a process run for a while
  sensor.failure = {failure, 4, for_frames, 0};
  return sensor;
}

std::unique_ptr<FrameSource> isolated(const SensorConfig& sensor) { return make_isolated_source(sensor, (*make_source(sensor))->info(), GFP_DAEMON_PROGRAM); }

long open_descriptors() { return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}); }

/// The error after at most 50 frames; counts them.
Error error_of(FrameSource& source, std::vector<Nanoseconds>& stamps) {
  for (int i = 0; i < 50; ++i) {
    const auto frame = source.grab(40s);
    if (!frame) return frame.error();
    stamps.push_back(frame->stamps.sensor);
  }
  return {ErrorCode::kTimeout, "no error"};
}

TEST(IsolatedSource, DeliversWhatTheDriverDelivers) {
  SensorConfig sensor = sensor_with("none", 0);
  const auto far = isolated(sensor);
  const auto near = make_source(sensor);
  ASSERT_TRUE(near);
  const auto opened = far->open();
  ASSERT_TRUE(opened) << opened.error().what;
  ASSERT_TRUE((*near)->open());
  const auto there = far->grab(30s), here = (*near)->grab(5s);
  ASSERT_TRUE(there) << there.error().what;
  EXPECT_EQ(there->sensor, "far");
  EXPECT_EQ(there->depth.pixels.pixels, here->depth.pixels.pixels);
  EXPECT_EQ(there->camera, here->camera);
  EXPECT_EQ(far->info().model, "virtual Kinect");
}

// A crash costs the process of the driver; the next one goes on, time goes forward, nothing is left behind.
TEST(IsolatedSource, ACrashIsNamedAndTheNextProcessGoesOn) {
  const auto source = isolated(sensor_with("crash", 1));
  ASSERT_TRUE(source->open());
  std::vector<Nanoseconds> stamps;
  long descriptors = 0;
  for (int cycle = 0; cycle < 3; ++cycle) {
    const Error error = error_of(*source, stamps);
    EXPECT_EQ(error.code, ErrorCode::kDeviceLost);
    EXPECT_TRUE(error.what.starts_with("crash: driver process")) << error.what;
    EXPECT_NE(error.what.find("signal 11"), std::string::npos) << error.what;
    source->close();
    if (cycle == 0) descriptors = open_descriptors();
    EXPECT_EQ(open_descriptors(), descriptors);
    const auto opened = source->open();
    ASSERT_TRUE(opened) << opened.error().what;
  }
  EXPECT_GE(stamps.size(), 12U);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
  EXPECT_EQ(std::adjacent_find(stamps.begin(), stamps.end()), stamps.end());
}

TEST(IsolatedSource, AHangIsFoundAndEnded) {
  const auto source = isolated(sensor_with("hang", 3600));
  ASSERT_TRUE(source->open());
  std::vector<Nanoseconds> stamps;
  const Error error = error_of(*source, stamps);
  EXPECT_EQ(error.code, ErrorCode::kDeviceLost);
  EXPECT_TRUE(error.what.starts_with("hang: driver process")) << error.what;
  EXPECT_EQ(stamps.size(), 4U);
  EXPECT_TRUE(source->open()) << "and a new process starts";
}

TEST(IsolatedSource, SaysWhyTheDriverDoesNotOpen) {
  SensorConfig sensor = sensor_with("none", 0);
  sensor.synthetic.table.classes = {"no_such_class"};
  EXPECT_EQ(isolated(sensor)->open().error().code, ErrorCode::kNotFound);
  sensor.synthetic.table.classes.clear();
  const auto source = make_isolated_source(sensor, {}, "/no/such/program");
  EXPECT_EQ(source->open().error().code, ErrorCode::kIo);
  EXPECT_EQ(source->grab(1ms).error().code, ErrorCode::kDeviceLost);
}

}  // namespace
}  // namespace gfp
