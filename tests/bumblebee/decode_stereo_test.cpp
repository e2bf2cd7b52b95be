#include "bumblebee/decode_stereo.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gfp {
namespace {

std::vector<std::uint8_t> counting(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

TEST(DecodeStereo, InterleavedBytesBelongToOneEyeEach) {
  const auto bytes = counting(2 * 6);
  const auto pair = decode_interleaved({3, 2, 2, bytes}, "right");
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->right.pixels, (std::vector<std::uint8_t>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(pair->left.pixels, (std::vector<std::uint8_t>{1, 3, 5, 7, 9, 11}));
  EXPECT_EQ(decode_interleaved({3, 2, 2, bytes}, "left")->left.pixels, pair->right.pixels);
}

TEST(DecodeStereo, OfThreeEyesTwoAreTaken) {
  const auto bytes = counting(3 * 4);
  const RawPicture raw{2, 2, 3, bytes};
  EXPECT_EQ(decode_interleaved(raw, "left", "outer")->left.pixels, (std::vector<std::uint8_t>{0, 3, 6, 9}));
  EXPECT_EQ(decode_interleaved(raw, "left", "outer")->right.pixels, (std::vector<std::uint8_t>{2, 5, 8, 11}));
  EXPECT_EQ(decode_interleaved(raw, "right", "left_centre")->right.pixels, (std::vector<std::uint8_t>{1, 4, 7, 10}));
  EXPECT_EQ(decode_interleaved(raw, "right", "left_centre")->left.pixels, (std::vector<std::uint8_t>{2, 5, 8, 11}));
  EXPECT_EQ(decode_interleaved(raw, "right", "centre_right")->left.pixels, (std::vector<std::uint8_t>{1, 4, 7, 10}));
}

TEST(DecodeStereo, StackedIsLeftAboveRight) {
  const auto bytes = counting(2 * 4);
  const auto pair = decode_stacked({2, 4, 1, bytes});
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.pixels, (std::vector<std::uint8_t>{0, 1, 2, 3}));
  EXPECT_EQ(pair->right.pixels, (std::vector<std::uint8_t>{4, 5, 6, 7}));
}

TEST(DecodeStereo, OneEyeOf16BitsIsItsUpperByte) {
  const auto bytes = counting(8);
  EXPECT_EQ(decode_single({2, 2, 2, bytes})->pixels, (std::vector<std::uint8_t>{1, 3, 5, 7}));
  EXPECT_EQ(decode_single({4, 2, 1, bytes})->pixels, bytes);
}

TEST(DecodeStereo, RefusesWhatIsCutOffOrOfAnotherFormat) {
  const auto bytes = counting(11);
  EXPECT_EQ(decode_interleaved({3, 2, 2, bytes}, "right").error().what, "picture has 11 bytes, expected 12");
  EXPECT_EQ(decode_interleaved({3, 2, 1, bytes}, "right").error().code, ErrorCode::kCorruptFrame);
  EXPECT_EQ(decode_stacked({2, 5, 1, bytes}).error().what, "two pictures in 5 rows, expected an even number above 3");
  EXPECT_FALSE(decode_interleaved({-3, 2, 2, bytes}, "right"));
  EXPECT_FALSE(decode_single({70'000, 70'000, 1, bytes}));
}

// A wall of one colour: the mosaic gives it back in every pattern, at the borders too.
TEST(DecodeStereo, AMosaicOfOneColourIsThatColour) {
  constexpr Rgb8 kColor{200, 100, 40};
  for (const std::string pattern : {"rggb", "bggr", "grbg", "gbrg"}) {
    StereoPair pair{Image<std::uint8_t>(7, 6), Image<std::uint8_t>(7, 6), {}};
    for (int v = 0; v < 6; ++v)
      for (int u = 0; u < 7; ++u) {
        const char filter = pattern[static_cast<std::size_t>(v % 2 * 2 + u % 2)];
        pair.left.at(u, v) = pair.right.at(u, v) = filter == 'r' ? kColor.r : filter == 'g' ? kColor.g : kColor.b;
      }
    take_off_mosaic(pair, pattern, true);
    for (const Rgb8& pixel : pair.color.pixels) ASSERT_EQ(pixel, kColor) << pattern;
    for (const int grey : pair.left.pixels) ASSERT_NEAR(grey, (200 + 2 * 100 + 40) / 4.0, 1) << pattern;
    EXPECT_EQ(pair.left.pixels, pair.right.pixels);
  }
}

}  // namespace
}  // namespace gfp
