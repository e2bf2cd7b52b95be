#include "replay/fit_pinhole.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"
#include "replay/files.hpp"

namespace gfp {
namespace {

const CameraModel kCamera{64, 48, 70.5, 71.25, 30.25, 24.75, DistortionModel::kNone, {}};

PcdCloud wall(const Axes& axes = {}) {
  auto cloud = decode_pcd(test::binary_pcd(test::draw_wall(kCamera, axes)), "wall");
  return std::move(*cloud);
}

/// All 48 ways to name and sign three axes.
std::vector<Axes> all_axes() {
  std::vector<Axes> all;
  for (const std::array<int, 3> index : {std::array{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}})
    for (int bits = 0; bits < 8; ++bits) all.push_back({index, {bits & 1 ? -1 : 1, bits & 2 ? -1 : 1, bits & 4 ? -1 : 1}});
  return all;
}

TEST(Axes, TextAndBackForEveryConvention) {
  for (const Axes& axes : all_axes()) EXPECT_EQ(parse_axes(to_string(axes)).value(), axes) << to_string(axes);
  EXPECT_EQ(parse_axes("+x-y-z").value(), parse_axes("x-y-z").value());
  for (const char* bad : {"", "xy", "xxz", "xyzx", "x y z", "xyw", "--xyz", "x-y-"}) EXPECT_FALSE(parse_axes(bad).has_value()) << bad;
}

TEST(Axes, KnowsMirrorImages) {
  EXPECT_FALSE(parse_axes("xyz")->left_handed());
  EXPECT_FALSE(parse_axes("x-y-z")->left_handed());
  EXPECT_FALSE(parse_axes("-y-zx")->left_handed());
  EXPECT_TRUE(parse_axes("x-yz")->left_handed());
  EXPECT_TRUE(parse_axes("yxz")->left_handed());
}

TEST(FitPinhole, FindsIntrinsicsAndAxesInEveryConvention) {
  for (const Axes& axes : all_axes()) {
    const auto fit = fit_pinhole(wall(axes), std::nullopt, "wall");
    ASSERT_TRUE(fit.has_value()) << to_string(axes) << ": " << fit.error().what;
    EXPECT_EQ(to_string(fit->axes), to_string(axes));
    EXPECT_NEAR(fit->camera.fx, kCamera.fx, 1e-3);  // float rounding of the points
    EXPECT_NEAR(fit->camera.fy, kCamera.fy, 1e-3);
    EXPECT_NEAR(fit->camera.cx, kCamera.cx, 1e-3);
    EXPECT_NEAR(fit->camera.cy, kCamera.cy, 1e-3);
    EXPECT_LT(fit->rms_px, 1e-4);
  }
}

TEST(FitPinhole, AWrongOverrideIsRefused) {
  const auto fit = fit_pinhole(wall(), parse_axes("x-y-z").value(), "wall.pcd");
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(fit.error().what.find("with axes x-y-z"), std::string::npos) << fit.error().what;
  EXPECT_TRUE(fit_pinhole(wall(), Axes{}, "wall.pcd").has_value());
}

TEST(FitPinhole, AFewStrayReadingsBehindTheCameraDoNotMatter) {
  PcdCloud cloud = wall();
  cloud.xyz[2][100] = -5;
  EXPECT_EQ(to_string(fit_pinhole(cloud, std::nullopt, "wall")->axes), "xyz");
}

TEST(FitPinhole, RefusesGridsThatNoPinholeCameraMade) {
  PcdCloud orthographic = wall(), shuffled = wall(), noise = wall();
  Random random(3);
  for (std::size_t i = 0; i < orthographic.xyz[0].size(); ++i) {
    orthographic.xyz[0][i] = static_cast<float>(i % 64) * orthographic.xyz[2][i] * orthographic.xyz[2][i];
    for (auto& column : noise.xyz) column[i] = static_cast<float>(random.uniform(0.1, 1));
  }
  std::swap(shuffled.width, shuffled.height);  // rows cut at the wrong place
  for (const PcdCloud* cloud : {&orthographic, &shuffled, &noise}) {
    const auto fit = fit_pinhole(*cloud, std::nullopt, "grid.pcd");
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error().code, ErrorCode::kUnsupported);
    EXPECT_NE(fit.error().what.find("not the grid of a pinhole camera"), std::string::npos) << fit.error().what;
  }
}

TEST(FitPinhole, SaysThatThereIsNothingToFit) {
  PcdCloud cloud = wall();
  for (auto& column : cloud.xyz) std::fill(column.begin(), column.end(), std::numeric_limits<float>::quiet_NaN());
  const auto fit = fit_pinhole(cloud, std::nullopt, "nan.pcd");
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, ErrorCode::kTooFewPoints);
  EXPECT_EQ(fit.error().what, "nan.pcd: finite points = 0 of 64 x 48, expected at least 100 to find the camera");
}

}  // namespace
}  // namespace gfp
