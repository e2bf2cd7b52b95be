#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "cloud/distortion.hpp"
#include "gfp/cloud/depth_to_cloud.hpp"

namespace gfp {
RayTable ray_table(const CameraModel& camera) {
  RayTable rays{camera, {}, {}};
  if (camera.width <= 0 || camera.height <= 0) return rays;
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  if (rays.separable()) {
    rays.x.resize(width);
    rays.y.resize(height);
    for (std::size_t u = 0; u < width; ++u) rays.x[u] = static_cast<float>(camera.ray(static_cast<double>(u), 0).x());
    for (std::size_t v = 0; v < height; ++v) rays.y[v] = static_cast<float>(camera.ray(0, static_cast<double>(v)).y());
    return rays;
  }
  const Distortion distortion(camera);
  rays.x.resize(width * height);
  rays.y.resize(width * height);
  for (std::size_t v = 0; v < height; ++v)
    for (std::size_t u = 0; u < width; ++u) {
      const Eigen::Vector2d ray = distortion.invert(camera.ray(static_cast<double>(u), static_cast<double>(v)).head<2>());
      rays.x[v * width + u] = static_cast<float>(ray.x());
      rays.y[v * width + u] = static_cast<float>(ray.y());
    }
  return rays;
}

}  // namespace gfp
