#include "gfp/cloud/depth_to_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

DepthImage constant_depth(std::uint16_t reading, int width = 640, int height = 480) {
  return {Image<std::uint16_t>(width, height, reading), 0.001};
}

// A wall 0.8 m away, seen head-on, comes back as the plane z = 0.8 with one point per pixel, each on its pixel's ray.
TEST(DepthToCloud, KeepsAWallFlatAndOrganised) {
  const CameraModel camera = default_kinect_camera();
  const OrganizedCloud cloud = depth_to_cloud(constant_depth(800), camera);
  ASSERT_EQ(cloud.size(), 640U * 480U);
  for (int v = 0; v < 480; v += 7)
    for (int u = 0; u < 640; u += 7) {
      const auto p = cloud.point(static_cast<std::size_t>(v * 640 + u)).cast<double>().eval();
      EXPECT_NEAR(p.z(), 0.8, 1e-6);  // float rounding only
      const Eigen::Vector2d pixel = camera.project(p);
      EXPECT_NEAR(pixel.x(), u, 1e-3);
      EXPECT_NEAR(pixel.y(), v, 1e-3);
    }
}

TEST(DepthToCloud, DropsZerosAndWhatIsOutOfRangeInAllThreeCoordinates) {
  DepthImage depth = constant_depth(1000, 4, 1);
  depth.pixels.pixels = {0, 299, 300, 6001};
  const OrganizedCloud cloud = depth_to_cloud(depth, default_kinect_camera(4, 1), {.min_depth_m = 0.3, .max_depth_m = 6.0});
  for (const std::size_t i : {0U, 1U, 3U}) {
    EXPECT_TRUE(std::isnan(cloud.x[i]) && std::isnan(cloud.y[i]) && std::isnan(cloud.z[i])) << "pixel " << i;
    EXPECT_FALSE(cloud.valid(i));
  }
  EXPECT_NEAR(cloud.z[2], 0.3, 1e-6);
}

TEST(DepthToCloud, UsesTheScale) {
  DepthImage depth = constant_depth(8000, 3, 3);
  depth.scale_m = 1e-4;
  EXPECT_NEAR(depth_to_cloud(depth, default_kinect_camera(3, 3)).z[4], 0.8, 1e-6);
  depth.scale_m = 0;  // nothing can be said of such readings
  EXPECT_FALSE(depth_to_cloud(depth, default_kinect_camera(3, 3)).valid(4));
}

TEST(DepthToCloud, AnswersAnImageThatIsNotTheCamerasWithNothing) {
  EXPECT_EQ(depth_to_cloud(constant_depth(800, 320, 240), default_kinect_camera()).size(), 0U);
  EXPECT_EQ(depth_to_cloud({}, {}).size(), 0U);
}

// OpenCV's plumb-bob and rational formulas applied to our ray lead back to the pixel.
TEST(DepthToCloud, RemovesDistortion) {
  for (const auto model : {DistortionModel::kPlumbBob, DistortionModel::kRationalPolynomial}) {
    CameraModel camera = default_kinect_camera();
    camera.distortion = model;
    camera.coefficients = {0.12, -0.25, 0.001, -0.0007, 0.09};
    if (model == DistortionModel::kRationalPolynomial) camera.coefficients.insert(camera.coefficients.end(), {0.02, -0.03, 0.004});
    const auto& k = camera.coefficients;
    const double k4 = k.size() > 5 ? k[5] : 0, k5 = k.size() > 5 ? k[6] : 0, k6 = k.size() > 5 ? k[7] : 0;
    const OrganizedCloud cloud = depth_to_cloud(constant_depth(900), camera);
    for (int v = 0; v < 480; v += 53)
      for (int u = 0; u < 640; u += 53) {
        const auto p = cloud.point(static_cast<std::size_t>(v * 640 + u)).cast<double>().eval();
        const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
        const double radial = (1 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2) / (1 + k4 * r2 + k5 * r2 * r2 + k6 * r2 * r2 * r2);
        EXPECT_NEAR(camera.fx * (x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x)) + camera.cx, u, 2e-3);
        EXPECT_NEAR(camera.fy * (y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y) + camera.cy, v, 2e-3);
      }
  }
}

// A lens whose polynomial folds over inside the image has no ray there: no point, rather than a wrong one.
TEST(DepthToCloud, LeavesOutPixelsThatTheLensCannotHave) {
  CameraModel camera = default_kinect_camera();
  camera.distortion = DistortionModel::kPlumbBob;
  camera.coefficients = {-2.0};
  const OrganizedCloud cloud = depth_to_cloud(constant_depth(900), camera);
  EXPECT_TRUE(cloud.valid(240 * 640 + 320));
  EXPECT_FALSE(cloud.valid(0));
}

TEST(DepthToCloud, GivesTheSameInAReusedBuffer) {
  Random random(1);
  OrganizedCloud reused;
  for (const int width : {64, 640, 33}) {
    DepthImage depth = constant_depth(0, width, 48);
    for (auto& reading : depth.pixels.pixels) reading = static_cast<std::uint16_t>(random.below(5000));
    const CameraModel camera = default_kinect_camera(width, 48);
    depth_to_cloud_into(depth, camera, {}, reused);
    const OrganizedCloud fresh = depth_to_cloud(depth, camera);
    ASSERT_EQ(reused.size(), fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      ASSERT_EQ(reused.valid(i), fresh.valid(i)) << width << " " << i;
      if (!fresh.valid(i)) continue;
      ASSERT_EQ(reused.point(i), fresh.point(i)) << width << " " << i;
    }
  }
}

}  // namespace
}  // namespace gfp
