#include "gfp/cloud/estimate_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/core/random.hpp"

namespace gfp {
namespace {

// A cloud whose depth along each ray is given; NaN: no reading. Exact, without a sensor's quantisation.
OrganizedCloud cloud_of(const CameraModel& camera, const std::function<double(double, double)>& depth_on_ray) {
  OrganizedCloud cloud;
  cloud.width = camera.width;
  cloud.height = camera.height;
  cloud.camera = camera;
  cloud.rays = ray_table(camera);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const auto i = static_cast<std::size_t>(v * camera.width + u);
      const float rx = cloud.rays.x[cloud.rays.separable() ? static_cast<std::size_t>(u) : i];
      const float ry = cloud.rays.y[cloud.rays.separable() ? static_cast<std::size_t>(v) : i];
      const auto z = static_cast<float>(depth_on_ray(rx, ry));
      cloud.x.push_back(rx * z);
      cloud.y.push_back(ry * z);
      cloud.z.push_back(z);
    }
  return cloud;
}

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 57.29577951308232;
}

// A plane is exactly linear in inverse depth, so every pixel has its normal, the outermost ones too.
TEST(EstimateNormals, AreExactOnAPlane) {
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, -0.8, -0.6), Eigen::Vector3d(0.36, -0.48, -0.8)}) {
    const OrganizedCloud cloud = cloud_of(default_kinect_camera(), [&](double x, double y) { return -0.7 / normal.dot(Eigen::Vector3d(x, y, 1)); });
    const NormalMap normals = estimate_normals(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_TRUE(normals.valid(i)) << i;
      ASSERT_LT(degrees_between(normals.normal(i).cast<double>(), normal), 0.2) << i;
    }
  }
}

TEST(EstimateNormals, FollowASphere) {
  const Eigen::Vector3d centre(0.02, -0.01, 0.6);
  const double radius = 0.08;
  const OrganizedCloud cloud = cloud_of(default_kinect_camera(), [&](double x, double y) {
    const Eigen::Vector3d ray(x, y, 1);
    const double along = ray.dot(centre), square = along * along - ray.squaredNorm() * (centre.squaredNorm() - radius * radius);
    return square < 0 ? std::numeric_limits<double>::quiet_NaN() : (along - std::sqrt(square)) / ray.squaredNorm();
  });
  const NormalMap normals = estimate_normals(cloud);
  int seen = 0, valid = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.valid(i)) {
      ASSERT_FALSE(normals.valid(i));
      continue;
    }
    ++seen;
    if (!normals.valid(i)) continue;
    ++valid;
    const Eigen::Vector3d truth = (cloud.point(i).cast<double>() - centre).normalized();
    if (truth.z() > -0.5) continue;
    ASSERT_LT(degrees_between(normals.normal(i).cast<double>(), truth), 3.0) << i;  // curvature over 9 pixels
  }
  EXPECT_GE(valid, 0.95 * seen);
}

// Two walls, one behind the other: up to the very edge each keeps its own normal.
TEST(EstimateNormals, DoNotMixSurfacesAcrossADepthEdge) {
  const Eigen::Vector3d near_normal = Eigen::Vector3d(0.3, 0, -1).normalized(), far_normal = Eigen::Vector3d(-0.4, -0.2, -1).normalized();
  const OrganizedCloud cloud = cloud_of(default_kinect_camera(320, 240), [&](double x, double y) {
    const Eigen::Vector3d ray(x, y, 1);
    return x < 0.01 ? -0.6 / near_normal.dot(ray) : -0.9 / far_normal.dot(ray);
  });
  const NormalMap normals = estimate_normals(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool near = cloud.x[i] / cloud.z[i] < 0.01F;
    ASSERT_TRUE(normals.valid(i));
    ASSERT_LT(degrees_between(normals.normal(i).cast<double>(), near ? near_normal : far_normal), 0.5) << i;
  }
}

TEST(EstimateNormals, SurviveNoiseHolesAndFillOnlyTheRegion) {
  Random random(7);
  const Eigen::Vector3d normal(0, -0.8, -0.6);
  const CameraModel camera = default_kinect_camera();
  const OrganizedCloud cloud = cloud_of(camera, [&](double x, double y) {
    const double inverse = -normal.dot(Eigen::Vector3d(x, y, 1)) / 0.6 + 0.0025 * random.normal();  // 1.2 mm at 0.7 m
    return random.uniform() < 0.05 || inverse < 0.2 ? std::numeric_limits<double>::quiet_NaN() : 1 / inverse;
  });
  const PixelRect rect{100, 200, 333, 410};
  const NormalMap normals = estimate_normals(cloud, {}, {rect});
  double sum = 0;
  int readings = 0, valid = 0;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      const auto i = static_cast<std::size_t>(v * 640 + u);
      if (!rect.contains(u, v)) {
        ASSERT_FALSE(normals.valid(i));
        continue;
      }
      readings += cloud.valid(i);
      if (!normals.valid(i)) continue;
      ++valid;
      sum += degrees_between(normals.normal(i).cast<double>(), normal);
    }
  EXPECT_GE(valid, 0.99 * readings);
  EXPECT_LT(sum / valid, 8.0);  // 25 of 81 taps beside every hole; the noise is a Kinect's
}

// With a distorted lens the ray's steps differ from pixel to pixel; a plane stays a plane.
TEST(EstimateNormals, AllowForTheLens) {
  CameraModel camera = default_kinect_camera();
  camera.distortion = DistortionModel::kPlumbBob;
  camera.coefficients = {0.2, -0.3, 0.001, 0.001, 0.0};
  const Eigen::Vector3d normal(0, -0.8, -0.6);
  const OrganizedCloud cloud = cloud_of(camera, [&](double x, double y) { return -0.7 / normal.dot(Eigen::Vector3d(x, y, 1)); });
  const NormalMap normals = estimate_normals(cloud);
  double worst = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_TRUE(normals.valid(i)) << i;
    worst = std::max(worst, degrees_between(normals.normal(i).cast<double>(), normal));
  }
  EXPECT_LT(worst, 1.0);
}

TEST(EstimateNormals, AnswersNothingWithNothing) {
  EXPECT_TRUE(estimate_normals({}).z.empty());
  const OrganizedCloud pixel = cloud_of(default_kinect_camera(1, 1), [](double, double) { return 0.5; });
  EXPECT_FALSE(estimate_normals(pixel).valid(0));
  const OrganizedCloud blind = cloud_of(default_kinect_camera(40, 30), [](double, double) { return std::numeric_limits<double>::quiet_NaN(); });
  const NormalMap normals = estimate_normals(blind, {}, {{-5, -5, 100, 100}});
  for (std::size_t i = 0; i < blind.size(); ++i) ASSERT_FALSE(normals.valid(i));
}

}  // namespace
}  // namespace gfp
