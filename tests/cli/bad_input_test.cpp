// The whole program on input that is broken, hostile, empty or too much: a clear error or an empty result, never a crash.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "cli/command.hpp"
#include "gfp/frame/png.hpp"
#include "support/mutate.hpp"
#include "support/table_frame.hpp"

namespace gfp {
namespace {

using test::CommandResult;
using test::run_gfp;

constexpr const char* kCamera = " --camera 525,525,319.5,239.5 --depth-scale 0.0001 ";

std::string pcd(const std::string& header_and_data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + header_and_data;
}

class BadInput : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& bytes) const { return folder_.write(name, bytes).string(); }
  std::string depth_png(const std::string& name, const Image<std::uint16_t>& depth) const {
    const auto path = folder_ / name;
    EXPECT_TRUE(write_png(path, depth));
    return path.string();
  }
  /// One line a problem, naming the file.
  static void expect_error(const CommandResult& result, int exit_code, const std::string& named) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_NE(result.err.find(named), std::string::npos) << result.err;
    EXPECT_TRUE(result.err.starts_with("gfp: ")) << result.err;
  }

  test::TemporaryFolder folder_;
};

TEST_F(BadInput, WhatIsNotThereIsNoInput) { expect_error(run_gfp("fit nowhere.pcd"), 66, "nowhere.pcd"); }

TEST_F(BadInput, WrongArgumentsAreUsage) {
  EXPECT_EQ(run_gfp("").exit_code, 64);
  EXPECT_EQ(run_gfp("fit").exit_code, 64);
  EXPECT_EQ(run_gfp("fit x.pcd --depth-scale minus").exit_code, 64);
  EXPECT_EQ(run_gfp("fit x.pcd --no-such-option").exit_code, 64);
  const CommandResult method = run_gfp("fit x.pcd --method guess");
  expect_error(method, 64, "method = guess, expected one of gfp_robust");
  expect_error(run_gfp("fit x.pcd --profile paperback"), 64, "expected one of");
  expect_error(run_gfp("fit x.pcd --class kettledrum"), 64, "expected one of");
  expect_error(run_gfp("fit x.pcd --camera 1,2,3"), 64, "1,2,3");
  EXPECT_EQ(run_gfp("--version").exit_code, 0);
  EXPECT_EQ(run_gfp("fit --help").exit_code, 0);
}

TEST_F(BadInput, BrokenCloudsAreDataErrors) {
  expect_error(run_gfp("fit " + file("empty.pcd", "")), 65, "empty.pcd");
  expect_error(run_gfp("fit " + file("text.pcd", "this is no cloud")), 65, "text.pcd");
  expect_error(run_gfp("fit " + file("huge.pcd", pcd("WIDTH 4000000000\nHEIGHT 4000000000\nPOINTS 16000000000000000000\nDATA binary\n"))), 65, "huge.pcd");
  expect_error(run_gfp("fit " + file("side.pcd", pcd("WIDTH 10000\nHEIGHT 10000\nPOINTS 100000000\nDATA binary\nxxxx"))), 65, "side.pcd");
  expect_error(run_gfp("fit " + file("short.pcd", pcd("WIDTH 640\nHEIGHT 480\nPOINTS 307200\nDATA binary\nonly a few bytes"))), 65, "short.pcd");
  expect_error(run_gfp("fit " + file("row.pcd", pcd("WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n0 0 1\n0 1 1\n1 0 1\n"))), 65, "row.pcd");
}

TEST_F(BadInput, MutatedCloudsNeverCrash) {
  std::string cloud = pcd("WIDTH 12\nHEIGHT 12\nPOINTS 144\nDATA ascii\n");
  for (int v = 0; v < 12; ++v)
    for (int u = 0; u < 12; ++u) cloud += std::to_string((u - 5.5) / 20) + " " + std::to_string((v - 5.5) / 20) + " 1\n";
  std::string names;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) names.append(" ").append(file("mutant" + std::to_string(seed) + ".pcd", test::mutated(cloud, seed, 200)));
  const CommandResult result = run_gfp("fit --json" + names);
  EXPECT_LT(result.exit_code, 128) << result.err.substr(result.err.size() > 500 ? result.err.size() - 500 : 0);
  EXPECT_NE(result.exit_code, 70) << result.err;
}

TEST_F(BadInput, BrokenImagesAreDataErrors) {
  const std::string good = depth_png("good.png", test::table_frame({}).depth.pixels);
  std::ifstream in(good, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  expect_error(run_gfp("fit " + file("cut.png", bytes.substr(0, bytes.size() / 2)) + kCamera), 65, "cut.png");
  std::string large = bytes;
  large.replace(16, 8, std::string("\0\0\x27\x10\0\0\x27\x10", 8));  // IHDR: 10000 x 10000
  expect_error(run_gfp("fit " + file("large.png", large) + kCamera), 65, "large.png");
  const auto grey = folder_ / "grey.png";
  ASSERT_TRUE(write_png(grey, Image<std::uint8_t>(64, 48, 7)));
  expect_error(run_gfp("fit " + grey.string() + kCamera), 65, "grey.png");
}

TEST_F(BadInput, BrokenCameraAndMaskAreNamed) {
  const std::string depth = depth_png("depth.png", Image<std::uint16_t>(640, 480, 0));
  for (const char* yaml : {"{", "fx: [1, 2", "fx: -5\nfy: 1\ncx: 0\ncy: 0\n", "&a [*a, *a]", "fx: .nan\nfy: 1\ncx: 0\ncy: 0\n", "fx: 525\nfy: 525\ncx: 1\ncy: 1\ncolour: red\n"}) {
    const CommandResult result = run_gfp("fit " + depth + " --camera " + file("camera.yaml", yaml));
    EXPECT_TRUE(result.exit_code == 64 || result.exit_code == 65) << yaml << ": " << result.exit_code << " " << result.err;
    EXPECT_NE(result.err.find("camera.yaml"), std::string::npos) << result.err;
  }
  expect_error(run_gfp("fit " + depth + kCamera + "--mask nowhere.png"), 66, "nowhere.png");
  const auto mask = folder_ / "mask.png";
  ASSERT_TRUE(write_png(mask, Image<std::uint8_t>(3, 2, 255)));
  expect_error(run_gfp("fit " + depth + kCamera + "--mask " + mask.string()), 64, "3 x 2");
}

// Frames without a single object are results: a line with an empty list.
TEST_F(BadInput, EmptyFramesAreEmptyScenes) {
  std::string nan = pcd("WIDTH 20\nHEIGHT 20\nPOINTS 400\nDATA ascii\n");
  for (int i = 0; i < 400; ++i) nan += "nan nan nan\n";
  for (const std::string& input : {depth_png("zero.png", Image<std::uint16_t>(640, 480, 0)) + kCamera, depth_png("dot.png", Image<std::uint16_t>(1, 1, 9000)) + " --camera 525,525,0,0",
                                   depth_png("table.png", test::table_frame({}).depth.pixels) + kCamera, file("nan.pcd", nan) + " --camera 525,525,10,10"}) {
    const CommandResult result = run_gfp("fit --json " + input);
    EXPECT_EQ(result.exit_code, 0) << input << result.err;
    ASSERT_EQ(result.lines().size(), 1U) << input;
    EXPECT_TRUE(result.lines()[0]["objects"].empty()) << input;
  }
}

TEST_F(BadInput, OneBadInputDoesNotStopTheOthers) {
  const std::string good = depth_png("good.png", test::table_frame({{0, 0}}).depth.pixels);
  const CommandResult result = run_gfp("fit --json nowhere.png " + good + " " + file("text.pcd", "no cloud") + kCamera);
  EXPECT_EQ(result.exit_code, 66) << "the first error's";
  EXPECT_NE(result.err.find("nowhere.png"), std::string::npos);
  EXPECT_NE(result.err.find("text.pcd"), std::string::npos);
  ASSERT_EQ(result.lines().size(), 1U);
  EXPECT_EQ(result.lines()[0]["objects"].size(), 1U);
}

TEST_F(BadInput, AHundredObjectsAreAllFitted) {
  std::vector<test::TableBox> boxes;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 10; ++column) boxes.push_back({-0.405 + 0.09 * column, -0.405 + 0.09 * row, {0.035, 0.035, 0.04}, 0.2});
  const CameraModel camera = default_kinect_camera(1280, 960);
  const std::string depth = depth_png("hundred.png", test::table_frame(boxes, camera, 1.2).depth.pixels);
  const CommandResult result = run_gfp("fit --json --method superquadric " + depth + " --camera 1050,1050,639.5,479.5 --depth-scale 0.0001");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ASSERT_EQ(result.lines().size(), 1U);
  EXPECT_GE(result.lines()[0]["objects"].size(), 95U);  // a few at the far corners may be cut by the image
}

}  // namespace
}  // namespace gfp
