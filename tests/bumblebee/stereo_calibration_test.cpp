#include "gfp/frame/stereo_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "config/stereo_calibration_file.hpp"
#include "gfp/cloud/rectify_stereo.hpp"

namespace gfp {
namespace {

StereoCalibration crooked_pair() {
  StereoCalibration c;
  c.left = {640, 480, 530, 532, 315, 244, DistortionModel::kPlumbBob, {-0.12, 0.05, 0.001, -0.0005, 0.01}};
  c.right = {640, 480, 527, 529, 324, 237, DistortionModel::kPlumbBob, {-0.10, 0.03, -0.001, 0.0005, 0}};
  c.T_right_left.linear() = rotation_from_vector({0.01, -0.02, 0.015});
  c.T_right_left.translation() = c.T_right_left.linear() * Eigen::Vector3d(-0.12, 0.003, -0.002);
  return c;
}

/// Brightness that depends on the direction alone, in the coordinates of the left camera: as if everything were infinitely far.
double sky(const Eigen::Vector3d& direction_left) {
  const Eigen::Vector2d d = direction_left.hnormalized();
  return 128 + 50 * std::sin(9 * d.x() + 2) + 50 * std::cos(11 * d.y() - 1);
}

/// What a camera with that lens sees of the sky; the lens is bent the slow way, by searching its pixel.
Image<std::uint8_t> photograph(const CameraModel& camera, const Eigen::Matrix3d& R_camera_left) {
  Image<std::uint8_t> picture(camera.width, camera.height);
  const auto& k = camera.coefficients;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d bent = camera.ray(u, v).head<2>();
      Eigen::Vector2d p = bent;
      for (int i = 0; i < 20; ++i) {  // fixed point: OpenCV's way
        const double r2 = p.squaredNorm(), radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
        const Eigen::Vector2d tangential(2 * k[2] * p.x() * p.y() + k[3] * (r2 + 2 * p.x() * p.x()), k[2] * (r2 + 2 * p.y() * p.y()) + 2 * k[3] * p.x() * p.y());
        p = (bent - tangential) / radial;
      }
      picture.at(u, v) = static_cast<std::uint8_t>(std::lround(sky(R_camera_left.transpose() * p.homogeneous())));
    }
  return picture;
}

// Of things infinitely far both eyes see the same once rectified, and it lies where the rectified camera says.
TEST(StereoRectifier, PutsTheSkyWhereItIs) {
  const StereoCalibration calibration = crooked_pair();
  const auto rectifier = StereoRectifier::make(calibration);
  ASSERT_TRUE(rectifier) << rectifier.error().what;
  EXPECT_NEAR(rectifier->geometry().baseline_m, Eigen::Vector3d(-0.12, 0.003, -0.002).norm(), 1e-12);
  const auto pair = rectifier->rectify({photograph(calibration.left, Eigen::Matrix3d::Identity()), photograph(calibration.right, calibration.T_right_left.linear()), {}});
  ASSERT_TRUE(pair);
  int seen = 0;
  for (int v = 0; v < 480; v += 3)
    for (int u = 0; u < 640; u += 3) {
      const double expected = sky(rectifier->rotation_left().transpose() * rectifier->geometry().camera.ray(u, v));
      for (const auto* eye : {&pair->left, &pair->right}) {
        if (eye->at(u, v) == 0) continue;  // outside of that eye's picture
        ++seen;
        ASSERT_NEAR(eye->at(u, v), expected, 1.6) << u << ", " << v;  // roundings of picture, weights and result
      }
    }
  EXPECT_GT(seen, 2 * 160 * 213 * 8 / 10);
}

// A point in front of both comes to lie on one row, f B / z apart.
TEST(StereoRectifier, RowsAlignAndDisparityIsFocalBaselineOverDepth) {
  const StereoCalibration calibration = crooked_pair();
  const auto rectifier = StereoRectifier::make(calibration).value();
  const RectifiedStereo& g = rectifier.geometry();
  for (const Eigen::Vector3d& left : {Eigen::Vector3d(0.1, -0.2, 0.9), Eigen::Vector3d(-0.3, 0.1, 1.4), Eigen::Vector3d(0, 0, 0.6)}) {
    const Eigen::Vector3d in_left = rectifier.rotation_left() * left, in_right = rectifier.rotation_right() * (calibration.T_right_left * left);
    const Eigen::Vector2d p = g.camera.project(in_left), q = g.camera.project(in_right);
    EXPECT_NEAR(p.y(), q.y(), 1e-9);
    EXPECT_NEAR(p.x() - q.x(), g.camera.fx * g.baseline_m / in_left.z(), 1e-9);
  }
}

TEST(StereoRectifier, RefusesPicturesOfAnotherSize) {
  const auto rectifier = StereoRectifier::make(crooked_pair());
  const auto pair = rectifier->rectify({Image<std::uint8_t>(640, 480), Image<std::uint8_t>(320, 480), {}});
  EXPECT_EQ(pair.error().code, ErrorCode::kCorruptFrame);
}

TEST(StereoCalibrationFile, WhatWasWrittenIsReadBack) {
  StereoCalibration written = crooked_pair();
  written.T_world_sensor.translation().z() = 1.5;
  const auto read = config::parse_opencv_stereo(config::to_opencv_yaml(written), "file.yaml");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->left, written.left);
  EXPECT_EQ(read->right, written.right);
  EXPECT_EQ(read->T_right_left.matrix(), written.T_right_left.matrix());
  EXPECT_EQ(read->T_world_sensor.matrix(), written.T_world_sensor.matrix());
}

TEST(StereoCalibrationFile, SaysWhatIsMissingOrWrong) {
  const auto error = [](const std::string& text) { return config::parse_opencv_stereo(text, "c.yaml").error().what; };
  EXPECT_EQ(error("M1: []\n"), "c.yaml: the size of the pictures is missing, expected width and height");
  EXPECT_EQ(error("width: 640\nheight: 480\n"), "c.yaml: M1 is missing, expected a matrix");
  EXPECT_EQ(error("width: 640\nheight: 480\nM1: [1, 2]\n"), "c.yaml: M1 has 2 numbers, expected 9 to 9");
  StereoCalibration squares = crooked_pair();  // T in squares of the board instead of metres
  squares.T_right_left.translation() *= 28;
  EXPECT_NE(error(config::to_opencv_yaml(squares)).find("expected [0.01, 2] m (T in metres)"), std::string::npos);
  StereoCalibration swapped = crooked_pair();
  swapped.T_right_left.translation() *= -1;
  EXPECT_NE(error(config::to_opencv_yaml(swapped)).find("to the right of the left one"), std::string::npos);
  EXPECT_EQ(config::load_stereo_calibration("/no/such.yaml").error().code, ErrorCode::kNotFound);
}

TEST(StereoCalibrationFile, ReadsAPairOfRosCameraInfos) {
  const auto info = [](double tx) {
    return "image_width: 640\nimage_height: 480\ncamera_name: eye\ncamera_matrix: {rows: 3, cols: 3, data: [530, 0, 320, 0, 530, 240, 0, 0, 1]}\ndistortion_model: plumb_bob\n"
           "distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 0.02, 0, 0, 0]}\nrectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
           "projection_matrix: {rows: 3, cols: 4, data: [500, 0, 320, " + std::to_string(tx) + ", 0, 500, 240, 0, 0, 0, 1, 0]}\n";
  };
  const auto read = config::parse_ros_stereo(info(0), info(-60), "left.yaml,right.yaml");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_DOUBLE_EQ(read->baseline_m(), 0.12);
  EXPECT_EQ(read->left.fx, 530);
  EXPECT_FALSE(config::parse_ros_stereo(info(0), info(0), "x")) << "no baseline";
}

}  // namespace
}  // namespace gfp
