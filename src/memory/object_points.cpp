#include "gfp/memory/object_points.hpp"

#include <cmath>

namespace gfp {

std::vector<Eigen::Vector3f> object_points(const ObjectView& view) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(static_cast<std::size_t>(view.object_pixels));
  for (int j = 0; j < view.depth_m.height; ++j)
    for (int i = 0; i < view.depth_m.width; ++i) {
      const float z = view.depth_m.at(i, j);
      if (view.evidence.at(i, j) != Evidence::kObject || !(z > 0) || !std::isfinite(z)) continue;
      points.push_back(view.camera.ray(view.tile.u0 + i, view.tile.v0 + j).cast<float>() * z);
    }
  return points;
}

}  // namespace gfp
