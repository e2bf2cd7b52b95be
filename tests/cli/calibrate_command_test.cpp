#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "gfp/frame/png.hpp"
#include "support/data_folder.hpp"

namespace gfp {
namespace {

std::string pairs() {
  std::string left = " --left", right = " --right";
  const auto folder = test::data_folder() / "stereo" / "opencv_chessboard";
  for (int i = 1; i <= 14; ++i) {
    if (i == 10) continue;  // there is none
    char number[8];
    std::snprintf(number, sizeof(number), "%02d.jpg", i);
    left.append(" ").append((folder / std::string("left").append(number)).string());
    right.append(" ").append((folder / std::string("right").append(number)).string());
  }
  return left + right;
}

// OpenCV's own chessboard pairs. OpenCV 4.6 with one focal length for both: 0.45 px and 3.34 squares.
TEST(CalibrateCommand, RealPairsGiveASmallErrorAndRowsThatAlign) {
  GFP_SKIP_WITHOUT(test::data_folder() / "stereo" / "opencv_chessboard");
  const test::TemporaryFolder folder;
  const std::string out = (folder / "c.yaml").string(), png = (folder / "c.png").string();
  const auto result = test::run_gfp("calibrate --board 9x6 --square 0.025 --json --out " + out + " --png " + png + pairs());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  EXPECT_GE(json["pairs"].get<int>(), 11);
  EXPECT_LT(json["rms_px"].get<double>(), 0.6);
  EXPECT_LT(json["row_error_px"].get<double>(), 0.4);
  EXPECT_NEAR(json["baseline_m"].get<double>(), 3.34 * 0.025, 0.05 * 3.34 * 0.025);
  const auto header = read_png_header(png);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->width, 2 * 640);
}

TEST(CalibrateCommand, SaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "grey.png", Image<std::uint8_t>(64, 48, 128)));
  const std::string grey = (folder / "grey.png").string(), out = " --out " + (folder / "c.yaml").string();
  EXPECT_EQ(test::run_gfp("calibrate --left " + grey).exit_code, 64);
  const auto uneven = test::run_gfp("calibrate --square 0.03 --left " + grey + " " + grey + " --right " + grey + out);
  EXPECT_NE(uneven.err.find("left pictures = 2, right pictures = 1"), std::string::npos) << uneven.err;
  const auto blank = test::run_gfp("calibrate --square 0.03 --left " + grey + " --right " + grey + out);
  EXPECT_NE(blank.err.find("pairs with the whole board = 0, expected at least 3"), std::string::npos) << blank.err;
  EXPECT_NE(blank.exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "c.yaml"));
}

}  // namespace
}  // namespace gfp
