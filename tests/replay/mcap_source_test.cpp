// Recordings as cameras: ours bit by bit, and those of ROS 2.
#include "replay/mcap_source.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>

#include "gfp/frame/png.hpp"
#include "gfp/recording/recording_file.hpp"
#include "replay/ros_messages.hpp"
#include "support/mutate.hpp"
#include "support/temporary_folder.hpp"
#include "wire/recorded_messages.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kPeriod{33'000'000};

/// Frame `i` of a recording: nothing in it has its default value.
Frame sample_frame(int i) {
  Frame frame;
  frame.sensor = "front";
  frame.sequence = static_cast<std::uint64_t>(100 + i);
  frame.stamps = {Nanoseconds(5'000'000'000) + i * kPeriod, Nanoseconds(7'000'000'000) + i * kPeriod, Nanoseconds(1'700'000'000'000'000'000) + i * kPeriod};
  frame.camera = {40, 30, 50.5, 51.25, 19.5, 14.75, DistortionModel::kPlumbBob, {0.1, -0.2, 0.001, 0.002, 0.05}};
  frame.depth = {Image<std::uint16_t>(40, 30), 0.00025};
  frame.color = Image<Rgb8>(40, 30);
  for (std::size_t k = 0; k < frame.depth.pixels.pixels.size(); ++k) {
    frame.depth.pixels.pixels[k] = static_cast<std::uint16_t>(k * 7 + static_cast<std::size_t>(i));
    frame.color.pixels[k] = {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k / 3), static_cast<std::uint8_t>(i)};
  }
  frame.noise = {0.002, 0.003, 0.5};
  frame.T_world_sensor.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  frame.T_world_sensor.linear() = rotation_from_vector({0.1, 0.2, 0.3});
  frame.up_camera = Eigen::Vector3d(0, -0.6, -0.8);
  return frame;
}

/// Frames of sensors in the order that is given.
std::filesystem::path record(const test::TemporaryFolder& folder, const std::vector<Frame>& frames) {
  const auto path = folder / "ours.mcap";
  auto file = RecordingFile::create(path);
  EXPECT_TRUE(file);
  RecordContent content;
  content.color = true;
  wire::RecordingMessages messages(content);
  for (const Frame& frame : frames)
    messages.put(frame, frame.stamps.realtime, [&](const McapChannelSpec& spec, const McapMessage& message) { EXPECT_TRUE(file->put(spec, message)); });
  EXPECT_TRUE(file->finish());
  return path;
}

std::filesystem::path record_samples(const test::TemporaryFolder& folder, int count) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) frames.push_back(sample_frame(i));
  return record(folder, frames);
}

ReplayOptions at_once() {
  ReplayOptions options;
  options.sensor = "front";
  options.rate_hz = 0;
  options.frame_time = true;
  return options;
}

std::vector<Frame> play(McapSource& source, std::size_t most = 100) {
  std::vector<Frame> frames;
  EXPECT_TRUE(source.open());
  while (frames.size() < most) {
    auto frame = source.grab(1s);
    if (!frame) break;
    frames.push_back(std::move(*frame));
  }
  return frames;
}

TEST(McapSource, GivesOurFramesBackBitByBit) {
  const test::TemporaryFolder folder;
  auto source = open_mcap(record_samples(folder, 5), at_once());
  ASSERT_TRUE(source) << source.error().what;
  const auto frames = play(**source);
  ASSERT_EQ(frames.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    const Frame &is = frames[static_cast<std::size_t>(i)], was = sample_frame(i);
    EXPECT_EQ(is.sensor, was.sensor);
    EXPECT_EQ(is.sequence, static_cast<std::uint64_t>(i));
    EXPECT_EQ(is.stamps.sensor, was.stamps.sensor);
    EXPECT_EQ(is.depth.pixels.pixels, was.depth.pixels.pixels);
    EXPECT_EQ(is.depth.scale_m, was.depth.scale_m);
    EXPECT_EQ(is.color.pixels, was.color.pixels);
    EXPECT_EQ(is.camera, was.camera);
    EXPECT_EQ(is.noise.quadratic_per_m, was.noise.quadratic_per_m);
    EXPECT_TRUE(is.T_world_sensor.matrix() == was.T_world_sensor.matrix());
    EXPECT_TRUE(*is.up_camera == *was.up_camera);
  }
  EXPECT_EQ((*source)->grab(1s).error().code, ErrorCode::kEndOfStream);
  EXPECT_EQ((*source)->report().camera_origin, CameraOrigin::kFile);
}

TEST(McapSource, StepsStartsLateAndLoops) {
  const test::TemporaryFolder folder;
  const auto file = record_samples(folder, 10);
  ReplayOptions options = at_once();
  options.step = 3;
  EXPECT_EQ(play(**open_mcap(file, options)).size(), 4U);
  options.step = 1;
  options.start_s = 0.1;  // the first frame at or after it is number 4, at 132 ms
  const auto late = play(**open_mcap(file, options));
  ASSERT_EQ(late.size(), 6U);
  EXPECT_EQ(late[0].stamps.sensor, sample_frame(4).stamps.sensor);
  options.loop = true;
  const auto looped = play(**open_mcap(file, options), 15);
  ASSERT_EQ(looped.size(), 15U);
  EXPECT_EQ(looped[6].depth.pixels.pixels, looped[0].depth.pixels.pixels);
  for (std::size_t i = 1; i < looped.size(); ++i) EXPECT_GT(looped[i].stamps.sensor, looped[i - 1].stamps.sensor);
}

TEST(McapSource, FollowsItsControl) {
  const test::TemporaryFolder folder;
  ReplayOptions options = at_once();
  options.control = std::make_shared<ReplayControl>();
  auto source = open_mcap(record_samples(folder, 10), options);
  ASSERT_TRUE(source && (*source)->open());
  EXPECT_EQ(options.control->state().duration, 9 * kPeriod);
  options.control->pause();
  EXPECT_EQ((*source)->grab(1ms).error().code, ErrorCode::kPaused);
  options.control->step();
  EXPECT_EQ((*source)->grab(1ms)->depth.pixels.pixels, sample_frame(0).depth.pixels.pixels);
  EXPECT_EQ((*source)->grab(1ms).error().code, ErrorCode::kPaused);
  options.control->seek(5 * kPeriod - 1ms);
  const auto sought = (*source)->grab(1ms);
  ASSERT_TRUE(sought) << "a seek shows its frame";
  EXPECT_EQ(sought->depth.pixels.pixels, sample_frame(5).depth.pixels.pixels);
  EXPECT_EQ(options.control->state().position, 5 * kPeriod);
  options.control->seek(0ns);
  options.control->resume();
  const auto back = (*source)->grab(1ms);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->depth.pixels.pixels, sample_frame(0).depth.pixels.pixels);
  EXPECT_GT(back->stamps.sensor, sought->stamps.sensor) << "time goes on rising after a jump back";
}

// A viewer's time line: it can be wound back from the end, and stamps are those of recording.
TEST(McapSource, HoldsAtItsEndForASeek) {
  const test::TemporaryFolder folder;
  ReplayOptions options = at_once();
  options.frame_time = false;
  options.recorded_time = true;
  options.control = std::make_shared<ReplayControl>();
  options.control->hold_at_end();
  auto source = open_mcap(record_samples(folder, 3), options);
  ASSERT_TRUE(source && (*source)->open());
  EXPECT_EQ(options.control->state().begin, sample_frame(0).stamps.realtime);
  for (int i = 0; i < 3; ++i) EXPECT_EQ((*source)->grab(1s)->stamps.realtime, sample_frame(i).stamps.realtime);
  const auto held = (*source)->grab(1ms);
  ASSERT_FALSE(held);
  EXPECT_EQ(held.error().code, ErrorCode::kPaused);
  EXPECT_TRUE(options.control->state().ended);
  options.control->seek(kPeriod);
  EXPECT_FALSE(options.control->state().ended);
  const auto again = (*source)->grab(1ms);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->stamps.realtime, sample_frame(1).stamps.realtime);
  EXPECT_EQ((*source)->info().rate_hz, 0) << "who is steered is not slow";
}

// The right sensor's recording begins three frames after the left one's and ends with it: both keep the time of recording.
TEST(McapSource, SeveralSensorsShareOneTimeLine) {
  constexpr int kLeft = 8, kLate = 3;
  const test::TemporaryFolder folder;
  std::vector<Frame> frames;
  for (int i = 0; i < kLeft; ++i) {
    frames.push_back(sample_frame(i));
    frames.back().sensor = "left";
    if (i < kLate) continue;
    frames.push_back(sample_frame(i));
    frames.back().sensor = "right";
  }
  const auto file = record(folder, frames);
  EXPECT_EQ(*McapStreams::recorded_sensors(file), (std::vector<std::string>{"left", "right"}));
  ReplayOptions options;
  options.recorded_time = true;
  options.control = std::make_shared<ReplayControl>();
  const auto player_of = [&](const std::string& sensor) {
    options.sensor = sensor;
    return *open_mcap(file, options);
  };
  options.sensor = "another";
  EXPECT_EQ((*McapStreams::open(file, options)).load(0)->report.notes, std::vector<std::string>{"other sensors left out: /gfp/sensor/right/depth/"});
  options.topic = "/gfp/sensor/right/depth/";
  EXPECT_EQ((*McapStreams::open(file, options)).recorded_sensor(), "right");
  options.topic.clear();
  const auto left = player_of("left"), right = player_of("right");
  ReplayControl& control = *options.control;
  EXPECT_EQ(control.state().begin, sample_frame(0).stamps.realtime);
  EXPECT_EQ(control.state().duration, (kLeft - 1) * kPeriod);
  ASSERT_TRUE(left->open() && right->open());

  EXPECT_EQ(left->grab(1ms)->stamps.realtime, sample_frame(0).stamps.realtime);
  EXPECT_EQ(right->grab(1ms).error().code, ErrorCode::kTimeout) << "its first frame is not due yet";
  EXPECT_EQ(right->grab(1s)->stamps.realtime, sample_frame(kLate).stamps.realtime);
  EXPECT_EQ(control.state().position, kLate * kPeriod) << "of whoever is furthest";

  control.pause();
  control.seek(5 * kPeriod);
  for (const auto* player : {&left, &right}) {
    EXPECT_EQ((*player)->grab(1ms)->stamps.realtime, sample_frame(5).stamps.realtime) << "a seek goes to all of them";
    EXPECT_EQ((*player)->grab(1ms).error().code, ErrorCode::kPaused);
  }
  control.set_speed(0);
  control.resume();
  while (left->grab(1s)) {}
  EXPECT_FALSE(control.state().ended) << "the right one has not ended";
  while (right->grab(1s)) {}
  EXPECT_TRUE(control.state().ended);
}

/// A message of ROS 2: CDR in either byte order.
class Cdr {
 public:
  explicit Cdr(bool big = false) : big_(big) { bytes_ = big ? std::string("\0\0\0\0", 4) : std::string("\0\1\0\0", 4); }
  template <class Number>
  Cdr& number(Number value) {
    while ((bytes_.size() - 4) % sizeof(Number) != 0) bytes_.push_back('\0');
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    if (big_) std::reverse(raw.begin(), raw.end());
    bytes_ += raw;
    return *this;
  }
  Cdr& text(const std::string& text) {
    number(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text + '\0';
    return *this;
  }
  Cdr& octets(const std::string& data) {
    number(static_cast<std::uint32_t>(data.size()));
    bytes_ += data;
    return *this;
  }
  Cdr& header(int i) { return number(std::int32_t{1'600'000'000}).number(static_cast<std::uint32_t>(i * kPeriod.count())).text("camera_depth_optical_frame"); }
  const std::string& bytes() const { return bytes_; }

 private:
  bool big_;
  std::string bytes_;
};

template <class Pixel>
std::string pixels_as_bytes(const std::vector<Pixel>& pixels) { return {reinterpret_cast<const char*>(pixels.data()), pixels.size() * sizeof(Pixel)}; }

std::string image_message(int i, const std::string& encoding, std::uint32_t bytes_per_pixel, const std::string& data, bool big = false) {
  return Cdr(big).header(i).number(std::uint32_t{30}).number(std::uint32_t{40}).text(encoding).number(std::uint8_t{0}).number(40 * bytes_per_pixel).octets(data).bytes();
}

std::string info_message(bool big = false) {
  Cdr cdr(big);
  cdr.header(0).number(std::uint32_t{30}).number(std::uint32_t{40}).text("plumb_bob").number(std::uint32_t{5});
  for (const double d : {0.1, -0.2, 0.001, 0.002, 0.0}) cdr.number(d);
  for (const double k : {50.5, 0.0, 19.5, 0.0, 51.25, 14.75, 0.0, 0.0, 1.0}) cdr.number(k);
  for (int i = 0; i < 21; ++i) cdr.number(0.0);  // R and P, which are not read
  return cdr.bytes();
}

std::string file_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct RosTopic {
  std::string topic, schema;
  std::vector<std::string> messages;
};

std::filesystem::path record_ros(const test::TemporaryFolder& folder, const std::vector<RosTopic>& topics) {
  const auto path = folder / "ros.mcap";
  auto file = RecordingFile::create(path);
  for (std::size_t i = 0; i < topics[0].messages.size(); ++i)
    for (const RosTopic& topic : topics) {
      if (i >= topic.messages.size()) continue;
      const auto time = static_cast<std::uint64_t>(1'600'000'000'000'000'000 + static_cast<std::int64_t>(i) * kPeriod.count());
      EXPECT_TRUE(file->put({topic.topic, "cdr", topic.schema, "ros2msg", "# text", {}}, {0, static_cast<std::uint32_t>(i), time, time, topic.messages[i]}));
    }
  EXPECT_TRUE(file->finish());
  return path;
}

TEST(McapSource, PlaysRawDepthOfRos) {
  for (const bool big : {false, true}) {
    const test::TemporaryFolder folder;
    const std::string data = pixels_as_bytes(sample_frame(0).depth.pixels.pixels);
    std::vector<std::string> images;
    for (int i = 0; i < 4; ++i) images.push_back(image_message(i, "16UC1", 2, data, big));
    const auto file = record_ros(folder, {{"/camera/depth/image_raw", "sensor_msgs/msg/Image", images},
                                          {"/other/camera_info", "sensor_msgs/msg/CameraInfo", {Cdr().header(0).bytes()}},
                                          {"/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", {info_message(big)}},
                                          {"/camera/color/image_raw", "sensor_msgs/msg/Image", {image_message(0, "bgr8", 3, pixels_as_bytes(sample_frame(0).color.pixels))}}});
    ReplayOptions options = at_once();
    options.color_topic = "/camera/color/image_raw";
    auto source = open_mcap(file, options);
    ASSERT_TRUE(source) << source.error().what;
    const auto frames = play(**source);
    ASSERT_EQ(frames.size(), 4U);
    EXPECT_EQ(frames[2].stamps.sensor, Nanoseconds(1'600'000'000'000'000'000) + 2 * kPeriod);
    EXPECT_EQ(frames[0].depth.pixels.pixels, sample_frame(0).depth.pixels.pixels);
    EXPECT_EQ(frames[0].depth.scale_m, 0.001);
    EXPECT_EQ(frames[0].camera.fx, 50.5);
    EXPECT_EQ(frames[0].camera.cy, 14.75);
    EXPECT_EQ(frames[0].camera.distortion, DistortionModel::kPlumbBob);
    ASSERT_FALSE(frames[0].color.empty());
    EXPECT_EQ(frames[0].color.pixels[7].r, sample_frame(0).color.pixels[7].b) << "bgr8";
  }
}

TEST(McapSource, PlaysFloatDepthOfRos) {
  const test::TemporaryFolder folder;
  std::vector<float> z(40 * 30, 1.25F);
  z[0] = std::numeric_limits<float>::quiet_NaN();
  z[1] = 2.5F;
  const auto file = record_ros(folder, {{"/depth", "sensor_msgs/msg/Image", {image_message(0, "32FC1", 4, pixels_as_bytes(z))}}});
  auto source = open_mcap(file, at_once());
  ASSERT_TRUE(source) << source.error().what;
  const auto frames = play(**source);
  ASSERT_EQ(frames.size(), 1U);
  const DepthImage& depth = frames[0].depth;
  EXPECT_EQ(depth.pixels.pixels[0], 0);
  EXPECT_NEAR(depth.pixels.pixels[1] * depth.scale_m, 2.5, 0.5 * depth.scale_m);
  EXPECT_NEAR(depth.pixels.pixels[2] * depth.scale_m, 1.25, 0.5 * depth.scale_m);
  EXPECT_EQ((*source)->report().camera_origin, CameraOrigin::kAssumed);
}

TEST(McapSource, PlaysCompressedDepthOfRos) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "depth.png", sample_frame(3).depth.pixels));
  const std::string png = file_bytes(folder / "depth.png");
  const std::string data = std::string(12, '\0') + png;
  const std::string message = Cdr().header(0).text("16UC1; compressedDepth png").octets(data).bytes();
  const auto file = record_ros(folder, {{"/camera/depth/image_raw/compressedDepth", "sensor_msgs/msg/CompressedImage", {message}},
                                        {"/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", {info_message()}}});
  auto source = open_mcap(file, at_once());
  ASSERT_TRUE(source) << source.error().what;
  const auto frames = play(**source);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].depth.pixels.pixels, sample_frame(3).depth.pixels.pixels);

  // 32FC1: inverse depth, z = a / (value - b).
  std::string coding(12, '\0');
  const float a = 1000, b = 10;
  std::memcpy(coding.data() + 4, &a, 4);
  std::memcpy(coding.data() + 8, &b, 4);
  Image<std::uint16_t> inverse(4, 1);
  inverse.pixels = {0, 510, 1010, 260};
  ASSERT_TRUE(write_png(folder / "inverse.png", inverse));
  const auto depth = depth_from_ros_compressed(Cdr().header(0).text("32FC1; compressedDepth png").octets(coding + file_bytes(folder / "inverse.png")).bytes(), 0.001);
  ASSERT_TRUE(depth) << depth.error().what;
  EXPECT_EQ(depth->pixels.pixels[0], 0);
  EXPECT_NEAR(depth->pixels.pixels[1] * depth->scale_m, 2.0, depth->scale_m);
  EXPECT_NEAR(depth->pixels.pixels[3] * depth->scale_m, 4.0, depth->scale_m);
}

TEST(McapSource, SaysWhatIsThereWhereNoDepthIs) {
  const test::TemporaryFolder folder;
  const auto file = record_ros(folder, {{"/imu", "sensor_msgs/msg/Imu", {"x"}}});
  const auto source = open_mcap(file, at_once());
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(source.error().what.find("/imu (sensor_msgs/msg/Imu)"), std::string::npos) << source.error().what;
  ReplayOptions options = at_once();
  options.speed = -1;
  EXPECT_EQ(open_mcap(file, options).error().code, ErrorCode::kInvalidArgument);
}

// Messages of strangers: an error or an image that fits its bytes.
TEST(McapSource, SurvivesHostileMessages) {
  const std::string image = image_message(0, "16UC1", 2, std::string(2400, 'x')), info = info_message();
  const std::string png = Cdr().header(0).text("16UC1; compressedDepth png").octets(std::string(12, '\0') + "\x89PNG\r\n\x1a\n").bytes();
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const auto depth = depth_from_ros_image(test::mutated(image, seed, 100), 0.001);
    EXPECT_TRUE(!depth || depth->pixels.pixels.size() == static_cast<std::size_t>(depth->pixels.width) * static_cast<std::size_t>(depth->pixels.height)) << "seed " << seed;
    (void)camera_from_ros_info(test::mutated(info, seed, info.size()));
    (void)depth_from_ros_compressed(test::mutated(png, seed, png.size()), 0.001);
    (void)color_from_ros_image(test::mutated(image, seed, 100));
  }
}

}  // namespace
}  // namespace gfp
