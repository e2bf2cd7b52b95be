#include "gfp/cloud/depth_to_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gfp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// The range as raw readings: comparing integers keeps the loop free of float rounding. Empty: low > high.
struct RawRange {
  std::int32_t low = 1, high = 0;
};

RawRange raw_range(const DepthToCloudOptions& options, double scale_m) {
  if (!(scale_m > 0)) return {};
  const double low = std::ceil(options.min_depth_m / scale_m - 1e-9), high = std::floor(options.max_depth_m / scale_m + 1e-9);
  return {static_cast<std::int32_t>(std::clamp(low, 1.0, 65536.0)), static_cast<std::int32_t>(std::clamp(high, 0.0, 65535.0))};
}

// One row with one ray y (separable), or with a ray y a pixel. NaN times anything is NaN: z alone carries validity.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void separable_row(const std::uint16_t* depth, int width, RawRange range, float scale, const float* ray_x, float ray_y,
                   float* __restrict x, float* __restrict y, float* __restrict z) {
  for (int u = 0; u < width; ++u) {
    const std::int32_t reading = depth[u];
    const float metres = static_cast<float>(reading) * scale;
    const float depth_m = ((reading >= range.low) & (reading <= range.high)) ? metres : kNaN;
    x[u] = ray_x[u] * depth_m;
    y[u] = ray_y * depth_m;
    z[u] = depth_m;
  }
}

__attribute__((target_clones("arch=x86-64-v3", "default")))
void general_row(const std::uint16_t* depth, int width, RawRange range, float scale, const float* ray_x, const float* ray_y,
                 float* __restrict x, float* __restrict y, float* __restrict z) {
  for (int u = 0; u < width; ++u) {
    const std::int32_t reading = depth[u];
    const float metres = static_cast<float>(reading) * scale;
    const bool seen = (reading >= range.low) & (reading <= range.high) & (ray_x[u] == ray_x[u]);
    const float depth_m = seen ? metres : kNaN;
    x[u] = ray_x[u] * depth_m;
    y[u] = ray_y[u] * depth_m;
    z[u] = depth_m;
  }
}

}  // namespace

OrganizedCloud depth_to_cloud(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions& options) {
  OrganizedCloud cloud;
  depth_to_cloud_into(depth, camera, options, cloud);
  return cloud;
}

void depth_to_cloud_into(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions& options, OrganizedCloud& cloud) {
  const int width = depth.pixels.width, height = depth.pixels.height;
  if (width != camera.width || height != camera.height || !validate(camera)) {
    cloud = OrganizedCloud{};
    return;
  }
  cloud.width = width;
  cloud.height = height;
  cloud.camera = camera;
  if (cloud.rays.x.empty() || !(cloud.rays.camera == camera)) cloud.rays = ray_table(camera);
  const std::size_t pixels = depth.pixels.pixels.size();
  for (auto* plane : {&cloud.x, &cloud.y, &cloud.z}) plane->resize(pixels);

  const RawRange range = raw_range(options, depth.scale_m);
  const auto scale = static_cast<float>(depth.scale_m);
  for (int v = 0; v < height; ++v) {
    const std::size_t at = depth.pixels.index(0, v);
    const std::uint16_t* row = &depth.pixels.pixels[at];
    if (cloud.rays.separable())
      separable_row(row, width, range, scale, cloud.rays.x.data(), cloud.rays.y[static_cast<std::size_t>(v)], &cloud.x[at], &cloud.y[at], &cloud.z[at]);
    else
      general_row(row, width, range, scale, &cloud.rays.x[at], &cloud.rays.y[at], &cloud.x[at], &cloud.y[at], &cloud.z[at]);
  }
}

}  // namespace gfp
