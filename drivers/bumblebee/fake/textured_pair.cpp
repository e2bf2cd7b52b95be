#include "bumblebee/fake/textured_pair.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

/// A value in [-1, 1) for a lattice point.
double lattice(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^ static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ULL;
  h = (h ^ (h >> 31)) * 0xBF58476D1CE4E5B9ULL;
  return static_cast<double>((h ^ (h >> 29)) >> 11) * 0x1.0p-52 - 1;
}

/// Value noise: trilinear between lattice points of one cell size.
double grain(const Eigen::Vector3d& point, double cell_m) {
  const Eigen::Vector3d p = point / cell_m;
  const Eigen::Vector3d corner(std::floor(p.x()), std::floor(p.y()), std::floor(p.z())), f = p - corner;
  double value = 0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
    const double weight = (dx ? f.x() : 1 - f.x()) * (dy ? f.y() : 1 - f.y()) * (dz ? f.z() : 1 - f.z());
    value += weight * lattice(static_cast<std::int64_t>(corner.x()) + dx, static_cast<std::int64_t>(corner.y()) + dy, static_cast<std::int64_t>(corner.z()) + dz);
  }
  return value;
}

Image<std::uint8_t> eye(const VirtualScene& scene, const CameraModel& camera, const Transform& T_world_camera, double noise, std::uint64_t seed) {
  VirtualCameraOptions perfect;
  perfect.noise_scale = 0;
  const Capture seen = capture(scene, camera, T_world_camera, perfect, 0);
  Random random(seed);
  Image<std::uint8_t> picture(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = picture.index(u, v);
      const Rgb8 color = seen.frame.color.pixels[i];
      const Eigen::Vector3d point = T_world_camera * (static_cast<double>(seen.truth.depth_m.pixels[i]) * camera.ray(u, v));
      const double brightness = 0.25 * color.r + 0.5 * color.g + 0.25 * color.b;
      const double texture = 0.5 * grain(point, 0.003) + 0.6 * grain(point, 0.008) + 0.5 * grain(point, 0.025);
      picture.pixels[i] = static_cast<std::uint8_t>(std::clamp(brightness * (1 + 0.5 * texture) + noise * random.normal(), 0.0, 255.0));
    }
  return picture;
}

}  // namespace

StereoPair textured_pair(const VirtualScene& scene, const CameraModel& camera, double baseline_m, const Transform& T_world_left, double noise, std::uint64_t seed) {
  const Transform T_world_right = T_world_left * Eigen::Translation3d(baseline_m, 0, 0);
  return {eye(scene, camera, T_world_left, noise, 2 * seed), eye(scene, camera, T_world_right, noise, 2 * seed + 1), {}};
}

StereoCalibration calibration_of_pair(const CameraModel& camera, double baseline_m, const Transform& T_world_left) {
  StereoCalibration calibration{camera, camera, Transform::Identity(), T_world_left};
  calibration.T_right_left.translation().x() = -baseline_m;
  return calibration;
}

}  // namespace gfp
