#include "replay/pclzf.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"
#include "replay/files.hpp"
#include "support/mutate.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

Image<std::uint16_t> ramp(int width, int height) {
  Image<std::uint16_t> image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<std::uint16_t>(500 + i / 3);
  return image;
}

TEST(Pclzf, DepthAndColourComeBack) {
  const test::TemporaryFolder folder;
  const Image<std::uint16_t> depth = ramp(40, 30);
  EXPECT_EQ(read_pclzf_depth(folder.write("a_depth.pclzf", test::depth_pclzf(depth)))->pixels, depth.pixels);
  const std::string planes = "RRRRrrGGGGggBBBBbb";
  const auto color = read_pclzf_color(folder.write("a_rgb.pclzf", test::pclzf(3, 2, "rgb24", planes)));
  ASSERT_TRUE(color.has_value()) << color.error().what;
  EXPECT_EQ(color->at(0, 0), (Rgb8{'R', 'G', 'B'}));
  EXPECT_EQ(color->at(2, 1), (Rgb8{'r', 'g', 'b'}));
}

TEST(Pclzf, NamesWhatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string valid = test::depth_pclzf(ramp(40, 30));
  const auto error = [&](const std::string& bytes) {
    const auto read = read_pclzf_depth(folder.write("bad_depth.pclzf", bytes));
    EXPECT_FALSE(read.has_value());
    return read ? Error{} : read.error();
  };
  const auto with = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = valid;
    std::memcpy(bytes.data() + at, &value, 4);
    return bytes;
  };
  EXPECT_EQ(error("").code, ErrorCode::kCorruptData);
  EXPECT_EQ(error("PCLZF").code, ErrorCode::kCorruptData);
  EXPECT_EQ(error(test::pclzf(2, 2, "yuv422", "abcdefgh")).code, ErrorCode::kUnsupported);
  EXPECT_EQ(error(with(5, 0)).code, ErrorCode::kCorruptData);
  EXPECT_EQ(error(with(5, 1'000'000'000)).code, ErrorCode::kTooLarge);
  EXPECT_EQ(error(with(5, 10'000)).code, ErrorCode::kTooLarge);
  EXPECT_EQ(error(with(5, 41)).code, ErrorCode::kCorruptData);
  EXPECT_EQ(error(with(29, 1U << 31U)).code, ErrorCode::kCorruptData);
  EXPECT_EQ(error(valid.substr(0, valid.size() - 1)).code, ErrorCode::kCorruptData);
  std::string bomb = test::pclzf(8000, 8000, "depth16", "tiny");
  const std::uint32_t size = 8000 * 8000 * 2;
  std::memcpy(bomb.data() + 33, &size, 4);
  EXPECT_NE(error(bomb).what.find("expected at most"), std::string::npos);
  EXPECT_EQ(read_pclzf_depth(folder / "absent.pclzf").error().code, ErrorCode::kNotFound);
}

TEST(Pclzf, CalibrationIsTheDepthCameras) {
  const auto calibration = parse_pclzf_calibration(test::kPclzfXml, "a.xml");
  ASSERT_TRUE(calibration.has_value()) << calibration.error().what;
  EXPECT_EQ(calibration->camera.fx, 525);
  EXPECT_EQ(calibration->camera.fy, 526);
  EXPECT_EQ(calibration->camera.cx, 320);
  EXPECT_EQ(calibration->camera.cy, 240);
  EXPECT_EQ(calibration->depth_scale_m, 0.001);
  EXPECT_EQ(parse_pclzf_calibration("", "a.xml").error().what, "a.xml: no <depth> section");
  EXPECT_EQ(parse_pclzf_calibration("<depth></depth>", "a.xml").error().what, "a.xml: <depth> has no number <focal_length_x>");
}

TEST(Pclzf, DamagedFilesGiveAnErrorOrAnImageNeverACrash) {
  const test::TemporaryFolder folder;
  const std::string depth = test::depth_pclzf(ramp(40, 30)), xml = test::kPclzfXml;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const auto read = read_pclzf_depth(folder.write("damaged.pclzf", test::mutated(depth, seed, 40)));
    if (!read) {
      ++refused;
      EXPECT_NE(read.error().what.find("damaged.pclzf"), std::string::npos) << read.error().what;
    }
    (void)parse_pclzf_calibration(test::mutated(xml, seed, xml.size()), "damaged.xml");
  }
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace gfp
