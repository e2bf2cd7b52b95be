// FireWire stereo cameras through a library that has libdc1394's functions and no bus.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "bumblebee/bumblebee_source.hpp"
#include "gfp/frame/run_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

BumblebeeOptions options_for(const char* guid) {
  BumblebeeOptions options;
  options.transport = "firewire";
  options.firewire_library = GFP_FAKE_DC1394;
  options.device = guid;
  options.threads = 1;
  return options;
}

/// The eyes are told apart by their brightness: 60 more for each byte, and the picture's number.
StereoToFrame checks(int left, int right, int& pictures) {
  return [left, right, &pictures](const StereoPair& pair, Frame&) -> Result<void> {
    EXPECT_EQ(pair.left.width, 64);
    EXPECT_EQ(pair.left.height, 48);
    const int number = pair.left.pixels[0] - left;
    const auto all = [](const Image<std::uint8_t>& eye, int value) { return std::all_of(eye.pixels.begin(), eye.pixels.end(), [&](std::uint8_t pixel) { return pixel == value; }); };
    EXPECT_TRUE(all(pair.left, left + number) && all(pair.right, right + number)) << "padding is no picture";
    return ++pictures, Result<void>{};
  };
}

TEST(Firewire, Bumblebee2DeliversWholePicturesUntilItIsUnplugged) {
  int pictures = 0;
  const auto source = make_bumblebee_source(options_for("00b09d0100000002"), checks(60, 0, pictures));
  const auto opened = source->open();
  ASSERT_TRUE(opened) << opened.error().what;
  std::vector<std::uint64_t> sequences;
  int corrupt = 0;
  Nanoseconds last{-1};
  auto frame = source->grab(1s);
  for (; frame || frame.error().code == ErrorCode::kCorruptFrame; frame = source->grab(1s)) {
    if (!frame) {
      ++corrupt;
      continue;
    }
    sequences.push_back(frame->sequence);
    EXPECT_GT(frame->stamps.sensor, last);
    last = frame->stamps.sensor;
  }
  EXPECT_EQ(frame.error().code, ErrorCode::kDeviceLost) << frame.error().what;
  EXPECT_EQ(corrupt, 2);
  EXPECT_EQ(sequences, (std::vector<std::uint64_t>{0, 1, 2, 3, 5, 6, 7, 8, 10, 11})) << "the fifth and tenth are incomplete";
  EXPECT_TRUE(source->open()) << "plugged in again";
  ASSERT_TRUE(frame = source->grab(1s)) << frame.error().what;
  EXPECT_GT(frame->stamps.sensor, last);
}

TEST(Firewire, OfAnXb3TwoEyesAreTaken) {
  const struct {
    const char *first, *eyes;
    int left, right;
  } cases[] = {{"right", "outer", 120, 0}, {"right", "left_centre", 120, 60}, {"right", "centre_right", 60, 0}, {"left", "outer", 0, 120}};
  for (const auto& one : cases) {
    int pictures = 0;
    BumblebeeOptions options = options_for("00b09d0100000003");
    options.first_byte = one.first;
    options.eyes = one.eyes;
    const auto source = make_bumblebee_source(options, checks(one.left, one.right, pictures));
    ASSERT_TRUE(source->open());
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(source->grab(1s));
    EXPECT_EQ(pictures, 3) << one.first << " " << one.eyes;
  }
}

TEST(Firewire, SaysWhatIsWrong) {
  const auto code = [](const BumblebeeOptions& options) { return make_bumblebee_source(options, {})->open().error().code; };
  EXPECT_EQ(code(options_for("no guid")), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(options_for("00b09d0100000009")), ErrorCode::kDeviceLost) << "not on the bus";
  BumblebeeOptions options = options_for("");
  options.pixel_format = "RGB8";
  EXPECT_EQ(code(options), ErrorCode::kUnsupported) << "a Bumblebee2 has no three eyes";
  options = options_for("");
  options.exposure_us = 1e6;
  EXPECT_EQ(code(options), ErrorCode::kUnsupported);
  options = options_for("");
  options.firewire_library = "libnothing.so.7";
  EXPECT_EQ(code(options), ErrorCode::kUnsupported);
}

// The real library, on a machine that most likely has no bus: an answer, no crash.
TEST(Firewire, TheRealLibraryAnswers) {
  BumblebeeOptions options;
  options.transport = "firewire";
  const auto source = make_bumblebee_source(options, {});
  const auto opened = source->open();
  if (opened) GTEST_SKIP() << "there is a camera";
  EXPECT_TRUE(opened.error().code == ErrorCode::kDeviceLost || opened.error().code == ErrorCode::kUnsupported) << opened.error().what;
}

}  // namespace
}  // namespace gfp
