#include "config/camera_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace gfp::config {
namespace {

const std::string kMinimal = "width: 640\nheight: 480\nfx: 525.5\nfy: 526\ncx: 319.5\ncy: 239.5\n";

TEST(CameraFile, ReadsWhatADepthCameraNeeds) {
  const auto file = parse_camera_file(kMinimal + "depth_scale: 0.0001\ndistortion: {model: plumb_bob, coefficients: [0.1, -0.2, 0, 0, 0]}\n"
                                                 "T_world_sensor: [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 1.2], [0, 0, 0, 1]]\n", "camera.yaml");
  ASSERT_TRUE(file.has_value()) << file.error().what;
  EXPECT_EQ(file->camera, (CameraModel{640, 480, 525.5, 526, 319.5, 239.5, DistortionModel::kPlumbBob, {0.1, -0.2, 0, 0, 0}}));
  EXPECT_EQ(file->depth_scale_m, 1e-4);
  EXPECT_TRUE((file->T_world_sensor * Eigen::Vector3d(0, 1, 1)).isApprox(Eigen::Vector3d(0, -1, 0.2), 1e-15));
}

TEST(CameraFile, LeavesTheScaleToTheFormatWhereItIsNotSaid) {
  const auto file = parse_camera_file(kMinimal, "camera.yaml");
  ASSERT_TRUE(file.has_value()) << file.error().what;
  EXPECT_FALSE(file->depth_scale_m.has_value());
  EXPECT_EQ(file->camera.distortion, DistortionModel::kNone);
}

TEST(CameraFile, RefusesWhatIsMissingOrImpossible) {
  EXPECT_EQ(parse_camera_file("width: 640\nheight: 480\nfx: 500\n", "c.yaml").error().what, "c.yaml: fy is missing");
  EXPECT_EQ(parse_camera_file("", "c.yaml").error().what, "c.yaml: width is missing");
  EXPECT_EQ(parse_camera_file("width: 100000\n", "c.yaml").error().what, "c.yaml:1: width = 100000, expected [1, 8192]");
  EXPECT_EQ(parse_camera_file("fx: 0\n", "c.yaml").error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(load_camera_file("/nowhere/camera.yaml").error().code, ErrorCode::kNotFound);
}

TEST(CameraFile, UsersGiveAFileOrFourNumbers) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "gfp_camera.yaml";
  std::ofstream(path) << kMinimal;
  ASSERT_TRUE(load_camera(path.string()).has_value());
  EXPECT_EQ(load_camera(path.string())->camera.width, 640);
  const auto given = load_camera("525,525,319.5,239.5");
  ASSERT_TRUE(given.has_value()) << given.error().what;
  EXPECT_EQ(given->camera.width, 0);
  EXPECT_EQ(given->camera.cx, 319.5);
  EXPECT_EQ(load_camera("525,525,x,239.5").error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace gfp::config
