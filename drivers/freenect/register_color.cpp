#include "freenect/register_color.hpp"

#include <cmath>

namespace gfp {

Image<Rgb8> register_color(const DepthImage& depth, const CameraModel& depth_camera, const Image<Rgb8>& color, const CameraModel& color_camera, double offset_m) {
  Image<Rgb8> registered(depth.pixels.width, depth.pixels.height);
  for (int v = 0; v < depth.pixels.height; ++v) {
    const int row = static_cast<int>(std::floor(color_camera.fy * (v - depth_camera.cy) / depth_camera.fy + color_camera.cy + 0.5));
    if (row < 0 || row >= color.height) continue;
    for (int u = 0; u < depth.pixels.width; ++u) {
      const double z = depth.scale_m * depth.pixels.at(u, v);
      if (z == 0) continue;
      const double x_over_z = (u - depth_camera.cx) / depth_camera.fx - offset_m / z;
      const int column = static_cast<int>(std::floor(color_camera.fx * x_over_z + color_camera.cx + 0.5));
      if (column >= 0 && column < color.width) registered.at(u, v) = color.at(column, row);
    }
  }
  return registered;
}

}  // namespace gfp
