#include "app/frame_ring.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <optional>

#include "gfp/core/random.hpp"
#include "support/moving_wall.hpp"

namespace gfp {
namespace {

class Ring : public ::testing::Test {
 protected:
  void SetUp() override {
    descriptor_ = FrameRing::create().value();
    writer_.emplace(FrameRing::map(descriptor_, true).value());
    reader_.emplace(FrameRing::map(descriptor_, false).value());
  }
  void TearDown() override { ::close(descriptor_); }

  int descriptor_ = -1;
  std::optional<FrameRing> writer_, reader_;
};

TEST_F(Ring, AFrameComesOutAsItWentIn) {
  Frame frame = test::wall_frame(5, 1.5);
  frame.color = Image<Rgb8>(64, 48, {1, 2, 3});
  frame.camera.distortion = DistortionModel::kPlumbBob;
  frame.camera.coefficients = {0.1, -0.2, 0, 0, 0.05};
  frame.T_world_sensor.translation() = Eigen::Vector3d(1, 2, 3);
  frame.up_camera = Eigen::Vector3d(0, -1, 0);
  frame.noise = {0.1, 0.2, 0.3};
  ASSERT_TRUE(writer_->write(0, frame));
  const auto read = reader_->read(0);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->depth.pixels.pixels, frame.depth.pixels.pixels);
  EXPECT_EQ(read->color.pixels, frame.color.pixels);
  EXPECT_EQ(read->camera, frame.camera);
  EXPECT_EQ(read->T_world_sensor.matrix(), frame.T_world_sensor.matrix());
  EXPECT_EQ(*read->up_camera, *frame.up_camera);
  EXPECT_EQ(read->stamps.sensor, frame.stamps.sensor);
  EXPECT_EQ(read->sequence, 5U);
  EXPECT_EQ(read->noise.quadratic_per_m, 0.2);
}

TEST_F(Ring, WhatWasOverwrittenIsNotRead) {
  for (std::uint64_t turn = 0; turn < 6; ++turn) ASSERT_TRUE(writer_->write(turn, test::wall_frame(turn, 0)));
  EXPECT_EQ(reader_->read(1).error().code, ErrorCode::kTimeout);
  EXPECT_EQ(reader_->read(6).error().code, ErrorCode::kTimeout) << "not written yet";
  EXPECT_EQ(reader_->read(5)->sequence, 5U);
}

TEST_F(Ring, TooManyPixelsAreRefused) {
  Frame frame = test::wall_frame(1, 0);
  frame.depth.pixels = Image<std::uint16_t>(2048, 1537);
  EXPECT_EQ(writer_->write(0, frame).error().code, ErrorCode::kTooLarge);
}

// A process that went wild writes anything anywhere: the reader says so, or gives a frame that is sound.
TEST_F(Ring, GarbageInSharedMemoryIsNoCrash) {
  const auto size = static_cast<std::size_t>(lseek(descriptor_, 0, SEEK_END));
  auto* const bytes = static_cast<std::uint8_t*>(mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0));
  ASSERT_NE(bytes, MAP_FAILED);
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    ASSERT_TRUE(writer_->write(0, test::wall_frame(seed, 0)));
    for (int i = 0; i < 6; ++i) bytes[8 + random.below(400)] = static_cast<std::uint8_t>(random.below(256));  // behind the version, into the header
    const auto frame = reader_->read(0);
    if (!frame) ++refused;
    else EXPECT_LE(frame->depth.pixels.pixels.size(), FrameRing::kMaxPixels) << seed;
  }
  EXPECT_GT(refused, 20);
  munmap(bytes, size);
}

}  // namespace
}  // namespace gfp
