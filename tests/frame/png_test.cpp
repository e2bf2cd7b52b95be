#include "gfp/frame/png.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "gfp/core/random.hpp"
#include "gfp/frame/read_file.hpp"
#include "support/mutate.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using test::TemporaryFolder;

Image<std::uint16_t> random_depth(int width, int height) {
  Image<std::uint16_t> image(width, height);
  Random random(1);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint16_t>(random.below(65536));
  return image;
}

TEST(Png, DepthComesBackBitForBit) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 1}, {1, 5}, {37, 23}}) {
    const Image<std::uint16_t> written = random_depth(width, height);
    ASSERT_TRUE(write_png(folder / "depth.png", written).has_value());
    const auto read = read_png_depth(folder / "depth.png");
    ASSERT_TRUE(read.has_value()) << read.error().what;
    EXPECT_EQ(read->width, width);
    EXPECT_EQ(read->pixels, written.pixels);
  }
}

TEST(Png, ColourAndGreyComeBackBitForBit) {
  const TemporaryFolder folder;
  Image<Rgb8> color(5, 4);
  Image<std::uint8_t> grey(5, 4);
  for (std::size_t i = 0; i < color.pixels.size(); ++i) {
    const auto value = static_cast<std::uint8_t>(10 * i);
    color.pixels[i] = {value, static_cast<std::uint8_t>(255 - value), 7};
    grey.pixels[i] = value;
  }
  ASSERT_TRUE(write_png(folder / "color.png", color).has_value());
  ASSERT_TRUE(write_png(folder / "grey.png", grey).has_value());
  EXPECT_EQ(read_png_color(folder / "color.png")->pixels, color.pixels);
  EXPECT_EQ(read_png_grey(folder / "grey.png")->pixels, grey.pixels);
  const auto grey_as_color = read_png_color(folder / "grey.png");
  EXPECT_EQ(grey_as_color->pixels[3], (Rgb8{30, 30, 30}));
}

TEST(Png, RefusesTheWrongKindOfPixels) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "color.png", Image<Rgb8>(4, 4)).has_value());
  const auto depth = read_png_depth(folder / "color.png");
  ASSERT_FALSE(depth.has_value());
  EXPECT_EQ(depth.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(depth.error().what.find("8 bit colour, expected 16 bit grey"), std::string::npos) << depth.error().what;
}

TEST(Png, NamesWhatIsWrongWithTheFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_png_depth(folder / "absent.png").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(read_png_depth(folder.path()).error().code, ErrorCode::kIo);
  EXPECT_EQ(read_png_depth(folder.write("empty.png", "")).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(read_png_depth(folder.write("text.png", std::string(100, 'x'))).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(write_png(folder / "none.png", Image<Rgb8>()).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(write_png(folder / "no" / "such" / "folder.png", Image<Rgb8>(1, 1)).error().code, ErrorCode::kIo);
}

// The size is refused from the header, whatever follows: 2^31 - 1 on a side would be eight exabytes.
TEST(Png, RefusesHugeSizesBeforeAllocating) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "small.png", random_depth(8, 8)).has_value());
  std::string bytes = *read_file(folder / "small.png", 1 << 20);
  std::memcpy(bytes.data() + 16, "\x7f\xff\xff\xff\x7f\xff\xff\xff", 8);
  const auto huge = read_png_depth(folder.write("huge.png", bytes));
  ASSERT_FALSE(huge.has_value());
  EXPECT_EQ(huge.error().code, ErrorCode::kTooLarge);
  EXPECT_NE(huge.error().what.find("2147483647"), std::string::npos) << huge.error().what;
}

TEST(Png, DamagedFilesGiveAnErrorOrAnImageNeverACrash) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "valid.png", random_depth(40, 30)).has_value());
  const std::string valid = *read_file(folder / "valid.png", 1 << 20);
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const auto path = folder.write("damaged.png", test::mutated(valid, seed, 60));
    const auto read = read_png_depth(path);
    if (!read) {
      ++refused;
      EXPECT_NE(read.error().what.find("damaged.png"), std::string::npos) << seed;
    }
    (void)read_png_color(path);
    (void)read_png_grey(path);
  }
  EXPECT_GT(refused, 300);  // the format has checksums: nearly all damage is seen
}

}  // namespace
}  // namespace gfp
