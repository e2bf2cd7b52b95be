// The driver against a camera of Aravis' own on the loopback interface: real GVCP and GVSP packets.
#include "bumblebee/bumblebee_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "bumblebee/fake/fake_bumblebee.hpp"
#include "gfp/core/random.hpp"
#include "support/gige_lock.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

/// Pictures that tell which pair they are of, and whether they are whole.
std::vector<StereoPair> pictures() {
  std::vector<StereoPair> pairs;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    StereoPair pair{Image<std::uint8_t>(640, 480), Image<std::uint8_t>(640, 480), {}};
    for (auto* eye : {&pair.left, &pair.right})
      for (auto& pixel : eye->pixels) pixel = static_cast<std::uint8_t>(random.next());
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

/// A source whose frames carry nothing; the pairs are compared where they arrive.
struct Receiver {
  std::vector<StereoPair> sent = pictures();
  std::atomic<int> whole{0}, damaged{0};  // pairs are matched on several threads

  StereoToFrame to_frame() {
    return [this](const StereoPair& pair, Frame&) -> Result<void> {
      const bool known = std::any_of(sent.begin(), sent.end(), [&](const StereoPair& one) { return one.left.pixels == pair.left.pixels && one.right.pixels == pair.right.pixels; });
      ++(known ? whole : damaged);
      return {};
    };
  }
};

BumblebeeOptions options() {
  BumblebeeOptions options;
  options.device = "Aravis-GFPBB01";
  return options;
}

/// Twenty pictures come whole, their time goes forward, and none is damaged; a busy machine may lose packets on the way.
void expect_whole_pictures(FrameSource& source, const Receiver& receiver) {
  Nanoseconds last{-1};
  for (int i = 0; i < 400 && receiver.whole < 20; ++i) {
    const auto frame = source.grab(2s);
    if (!frame) continue;
    EXPECT_GT(frame->stamps.sensor, last);
    last = frame->stamps.sensor;
  }
  EXPECT_EQ(receiver.whole, 20);
  EXPECT_EQ(receiver.damaged, 0);
}

TEST(Bumblebee, EveryPictureArrivesWholeAndTimeGoesForward) {
  const test::GigeLock lock;
  Receiver receiver;
  const auto fake = FakeBumblebee::start(receiver.sent);
  ASSERT_TRUE(fake) << fake.error().what;
  const auto source = make_bumblebee_source(options(), receiver.to_frame());
  const auto opened = source->open();
  ASSERT_TRUE(opened) << opened.error().what;
  expect_whole_pictures(*source, receiver);
}

TEST(Bumblebee, AnIncompletePictureIsNeverPassedOn) {
  const test::GigeLock lock;
  Receiver receiver;
  FakeBumblebeeOptions lossy;
  lossy.camera.lost_packets = 0.001;  // of 440 packets a frame
  lossy.camera.resends = false;
  const auto fake = FakeBumblebee::start(receiver.sent, lossy);
  ASSERT_TRUE(fake) << fake.error().what;
  const auto source = make_bumblebee_source(options(), receiver.to_frame());
  ASSERT_TRUE(source->open());
  int corrupt = 0;
  for (int i = 0; i < 400 && (receiver.whole < 10 || corrupt < 5); ++i) {
    const auto frame = source->grab(2s);
    corrupt += !frame && frame.error().code == ErrorCode::kCorruptFrame ? 1 : 0;
  }
  EXPECT_GE(corrupt, 5);
  EXPECT_GE(receiver.whole, 10);
  EXPECT_EQ(receiver.damaged, 0);
}

// Every picture of the camera is either passed on whole or counted as incomplete, however many packets are lost.
TEST(Bumblebee, EveryPictureIsAccountedFor) {
  const test::GigeLock lock;
  for (const double lost_packets : {0.001, 0.005, 0.01, 0.02}) {
    Receiver receiver;
    FakeBumblebeeOptions lossy;
    lossy.camera.lost_packets = lost_packets;
    lossy.camera.resends = false;
    const auto fake = FakeBumblebee::start(receiver.sent, lossy);
    ASSERT_TRUE(fake) << fake.error().what;
    BumblebeeOptions large = options();
    large.packet_bytes = 8000;  // 78 packets a picture, so that some are whole at 2 %
    const auto source = make_bumblebee_source(large, receiver.to_frame());
    ASSERT_TRUE(source->open());
    int incomplete = 0;
    std::uint64_t last = 0;
    for (int i = 0; i < 30; ++i) {
      const auto frame = source->grab(2s);
      incomplete += !frame && frame.error().code == ErrorCode::kCorruptFrame ? 1 : 0;
      if (frame) last = frame->sequence;
    }
    source->close();
    const int whole = receiver.whole, accounted = whole + incomplete;
    std::printf("packets lost: %.1f %%: %llu pictures sent, %d whole, %d incomplete; expected whole: %.0f %%\n", 100 * lost_packets, static_cast<unsigned long long>((*fake)->sent()), whole, incomplete,
                100 * std::pow(1 - lost_packets, 78 + 2));
    EXPECT_EQ(receiver.damaged, 0);
    EXPECT_GE(accounted, 29);
    EXPECT_LE(static_cast<std::uint64_t>(accounted), (*fake)->sent());
    EXPECT_LT(last, (*fake)->sent()) << "sequences count the camera's pictures";
  }
}

TEST(Bumblebee, PluggedInAgainItGoesOn) {
  const test::GigeLock lock;
  Receiver receiver;
  const auto source = make_bumblebee_source(options(), receiver.to_frame());
  EXPECT_EQ(source->open().error().code, ErrorCode::kDeviceLost) << "nothing is plugged in";
  Nanoseconds last{-1};
  for (int cycle = 0; cycle < 2; ++cycle) {
    auto fake = FakeBumblebee::start(receiver.sent);
    ASSERT_TRUE(fake) << fake.error().what;
    const auto opened = source->open();
    ASSERT_TRUE(opened) << opened.error().what;
    Result<Frame> frame = failure(ErrorCode::kTimeout, "");
    for (int attempt = 0; attempt < 50 && !frame; ++attempt) frame = source->grab(500ms);
    ASSERT_TRUE(frame) << frame.error().what;
    EXPECT_GT(frame->stamps.sensor, last);
    last = frame->stamps.sensor;
    fake->reset();
    for (int attempt = 0; attempt < 10 && frame; ++attempt) frame = source->grab(200ms);  // what was under way
    EXPECT_FALSE(frame);
    source->close();
  }
}

// Losses are asked for again, and again where that was lost as well.
TEST(Bumblebee, LostPacketsAreSentAgain) {
  const test::GigeLock lock;
  Receiver receiver;
  FakeBumblebeeOptions lossy;
  lossy.camera.lost_packets = 0.01;  // of 440 packets a frame: 1 frame in 80 would be whole
  const auto fake = FakeBumblebee::start(receiver.sent, lossy);
  ASSERT_TRUE(fake) << fake.error().what;
  const auto source = make_bumblebee_source(options(), receiver.to_frame());
  ASSERT_TRUE(source->open());
  int grabs = 0;
  for (; grabs < 400 && receiver.whole < 40; ++grabs) (void)source->grab(2s);
  std::printf("1 %% of packets lost, %llu sent again: %d of %d pictures whole\n", static_cast<unsigned long long>((*fake)->resent()), receiver.whole.load(), grabs);
  EXPECT_EQ(receiver.damaged, 0);
  EXPECT_GE(receiver.whole, 40);
  EXPECT_LE(grabs, 60);
  EXPECT_GE((*fake)->resent(), 40U);
}

struct Layout {
  const char* fake;
  const char* options;
};
class BumblebeeLayout : public ::testing::TestWithParam<Layout> {};

TEST_P(BumblebeeLayout, BothEyesArriveWhole) {
  const test::GigeLock lock;
  Receiver receiver;
  FakeBumblebeeOptions camera;
  camera.layout = GetParam().fake;
  const auto fake = FakeBumblebee::start(receiver.sent, camera);
  ASSERT_TRUE(fake) << fake.error().what;
  BumblebeeOptions of_layout = options();
  of_layout.layout = GetParam().options;
  const auto source = make_bumblebee_source(of_layout, receiver.to_frame());
  const auto opened = source->open();
  ASSERT_TRUE(opened) << opened.error().what;
  expect_whole_pictures(*source, receiver);
}

INSTANTIATE_TEST_SUITE_P(, BumblebeeLayout, ::testing::Values(Layout{"interleaved", "interleaved"}, Layout{"stacked", "stacked"}, Layout{"parts", "stacked"}),
                         [](const auto& of) { return std::string(of.param.fake); });

/// Two cameras of one eye each, on two addresses, which send together.
struct TwoCameras {
  explicit TwoCameras(const std::vector<StereoPair>& pairs, double lost_packets = 0) {
    for (const char* eye : {"left", "right"}) {
      FakeBumblebeeOptions one;
      one.layout = eye;
      one.camera.serial = std::string("GFPBB_") + eye;
      one.camera.address = eyes.empty() ? "127.0.0.1" : "127.0.0.2";
      one.camera.lost_packets = lost_packets;
      one.camera.resends = false;
      auto started = FakeBumblebee::start(pairs, one);
      EXPECT_TRUE(started) << started.error().what;
      if (started) eyes.push_back(std::move(*started));
    }
  }
  static BumblebeeOptions options() {
    BumblebeeOptions both;
    both.layout = "two_devices";
    both.device = "Aravis-GFPBB_left,Aravis-GFPBB_right";
    return both;
  }
  std::vector<std::unique_ptr<FakeBumblebee>> eyes;
};

TEST(Bumblebee, TwoCamerasAreOne) {
  const test::GigeLock lock;
  Receiver receiver;
  const std::vector<StereoPair> one{receiver.sent.front()};  // which picture a camera begins with is its own affair
  const TwoCameras cameras(one);
  ASSERT_EQ(cameras.eyes.size(), 2U);
  const auto source = make_bumblebee_source(TwoCameras::options(), receiver.to_frame());
  const auto opened = source->open();
  ASSERT_TRUE(opened) << opened.error().what;
  expect_whole_pictures(*source, receiver);
}

// One eye's loss costs that pair: what follows belongs together again.
TEST(Bumblebee, TwoCamerasStayInStepWhenOneLosesPictures) {
  const test::GigeLock lock;
  Receiver receiver;
  const TwoCameras cameras(receiver.sent, 0.0005);
  ASSERT_EQ(cameras.eyes.size(), 2U);
  const auto source = make_bumblebee_source(TwoCameras::options(), receiver.to_frame());
  ASSERT_TRUE(source->open());
  int corrupt = 0;
  for (int i = 0; i < 400 && (corrupt < 5 || receiver.whole + receiver.damaged < 20); ++i) {
    const auto frame = source->grab(2s);
    corrupt += !frame && frame.error().code == ErrorCode::kCorruptFrame ? 1 : 0;
  }
  source->close();
  EXPECT_GE(corrupt, 5);
  EXPECT_TRUE(receiver.whole == 0 || receiver.damaged == 0) << receiver.whole << " pairs of one picture's eyes, " << receiver.damaged << " of two";
}

TEST(Bumblebee, OneOfTwoCamerasUnplugged) {
  const test::GigeLock lock;
  Receiver receiver;
  TwoCameras cameras({receiver.sent.front()});
  ASSERT_EQ(cameras.eyes.size(), 2U);
  const auto source = make_bumblebee_source(TwoCameras::options(), receiver.to_frame());
  ASSERT_TRUE(source->open());
  Result<Frame> frame = failure(ErrorCode::kTimeout, "");
  for (int i = 0; i < 50 && !frame; ++i) frame = source->grab(2s);
  ASSERT_TRUE(frame) << frame.error().what;
  cameras.eyes.pop_back();
  for (int i = 0; i < 20 && frame; ++i) frame = source->grab(500ms);  // what was under way
  EXPECT_FALSE(frame) << "no frame of one eye";
}

TEST(Bumblebee, TwoDevicesNeedTwoNames) {
  BumblebeeOptions two;
  two.layout = "two_devices";
  two.device = "only_one";
  EXPECT_EQ(make_bumblebee_source(two, {})->open().error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(make_bumblebee_source(two, {})->grab(1ms).error().code, ErrorCode::kDeviceLost) << "not open";
}

}  // namespace
}  // namespace gfp
