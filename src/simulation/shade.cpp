#include "simulation/shade.hpp"

#include <algorithm>

namespace gfp {
namespace {

Rgb8 scaled(Rgb8 color, float brightness) {
  const float level = std::clamp(brightness, 0.0F, 1.0F);
  const auto part = [level](std::uint8_t value) { return static_cast<std::uint8_t>(level * value + 0.5F); };
  return {part(color.r), part(color.g), part(color.b)};
}

/// Brightness as one affine function of u/z', v/z'... per triangle: with w_k(ray) = ray . edge_k (signed volumes), it is
/// sum(w_k b_k) / sum(w_k), and both sums are dot products of the ray with one vector.
struct Shading {
  Eigen::Vector3f weighted = Eigen::Vector3f::Zero(), plain = Eigen::Vector3f::Zero();

  Shading() = default;
  Shading(const Facet& facet, const std::vector<Eigen::Vector3d>& vertices) {
    const auto corner = [&](std::size_t k) -> const Eigen::Vector3d& { return vertices[static_cast<std::size_t>(facet.corner[k])]; };
    const Eigen::Vector3d edges[3] = {corner(1).cross(corner(2)), corner(2).cross(corner(0)), corner(0).cross(corner(1))};
    Eigen::Vector3d b = Eigen::Vector3d::Zero(), one = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) b += facet.brightness[k] * edges[k], one += edges[k];
    const double norm = std::max(one.norm(), 1e-300);
    weighted = (b / norm).cast<float>(), plain = (one / norm).cast<float>();
  }
  float at(const Eigen::Vector3f& ray) const { return weighted.dot(ray) / plain.dot(ray); }
};

}  // namespace

Image<Rgb8> shade(const Rendering& rendering, const CameraModel& camera) {
  Image<Rgb8> color(rendering.tile.width, rendering.tile.height);
  const float fx = static_cast<float>(1 / camera.fx), fy = static_cast<float>(1 / camera.fy);
  const float cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  std::int32_t last = -1;  // neighbours mostly show the same facet
  Rgb8 flat;
  Shading shading;
  for (int v = 0; v < color.height; ++v) {
    for (int u = 0; u < color.width; ++u) {
      const std::size_t i = color.index(u, v);
      const std::int32_t index = rendering.tile.triangle[i];
      if (index < 0) continue;
      const Facet& facet = rendering.facets[static_cast<std::size_t>(index)];
      const bool is_flat = facet.corner[0] < 0;
      if (index != last) {
        if (is_flat) flat = scaled(facet.color, facet.brightness[0]);
        else shading = Shading(facet, rendering.vertices_camera);
        last = index;
      }
      const Eigen::Vector3f ray((static_cast<float>(u) - cx) * fx, (static_cast<float>(v) - cy) * fy, 1.0F);
      color.pixels[i] = is_flat ? flat : scaled(facet.color, shading.at(ray));
    }
  }
  return color;
}

}  // namespace gfp
