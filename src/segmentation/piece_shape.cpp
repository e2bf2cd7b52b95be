#include "segmentation/piece_shape.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr int kSearchPx = 24;

// The step of the pixel index that leads downwards in the world, as far as the image's axes tell.
std::int32_t downwards(const FlatSurface* support, int width) {
  if (support == nullptr || std::abs(support->up.x()) <= std::abs(support->up.y())) return support != nullptr && support->up.y() > 0.2 ? -width : width;
  return support->up.x() > 0 ? -1 : 1;
}

constexpr std::int32_t kOutside = -1, kNothing = -2;

/// The pixel of the next reading from pixel i; kOutside beyond the image, kNothing near.
std::int32_t next_reading(const std::vector<std::uint8_t>& valid, int width, std::int32_t i, std::int32_t step) {
  for (std::int32_t n = i + step, k = 1; k <= kSearchPx; ++k, n += step) {
    if (n < 0 || n >= static_cast<std::int32_t>(valid.size()) || (std::abs(step) == 1 && n / width != i / width)) return kOutside;
    if (valid[static_cast<std::size_t>(n)] != 0) return n;
  }
  return kNothing;
}

}  // namespace

void PieceShape::add(const PieceShape& o) {
  pixels += o.pixels;
  base_m = std::min(base_m, o.base_m);
  top_m = std::max(top_m, o.top_m);
  foot += o.foot;
  foot_hidden += o.foot_hidden;
  open += o.open;
  normals += o.normals;
  point += o.point;
  normal += o.normal;
  normal_dot_point += o.normal_dot_point;
  squared_distance += o.squared_distance;
}

PieceShape piece_shape(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid, int piece,
                       const FlatSurface* support, double tolerance_m) {
  const PixelList& pixels = map.pixels[static_cast<std::size_t>(piece)];
  PieceShape shape;
  shape.pixels = static_cast<int>(pixels.size());
  const std::int32_t down = downwards(support, cloud.width);
  const auto within = [&](std::int32_t n) { return n >= 0 && n < static_cast<std::int32_t>(map.piece.size()); };  // a row's ends meet: that is as good as none
  std::vector<float> heights;
  heights.reserve(pixels.size());
  const std::size_t every = pixels.size() / 1500 + 1;  // plenty for the quantiles
  std::size_t k = 0;
  for (const auto i : pixels) {
    const Eigen::Vector3d p = cloud.point(static_cast<std::size_t>(i)).cast<double>();
    if (k++ % every == 0) heights.push_back(support != nullptr ? static_cast<float>(support->height(cloud, i)) : static_cast<float>(-p.y()));
    if (const Eigen::Vector3f n = map.normal(i); n.x() == n.x()) {
      const Eigen::Vector3d normal = n.cast<double>();
      shape.normals += 1;
      shape.point += p;
      shape.normal += normal;
      shape.normal_dot_point += normal.dot(p);
      shape.squared_distance += p.squaredNorm();
    }
    const double limit = 3.0 * tolerance_m * std::max(1.0, p.z() * p.z());
    for (const std::int32_t step : {1, -1, cloud.width, -cloud.width}) {
      if (within(i + step) && map.piece[static_cast<std::size_t>(i + step)] == piece) continue;  // nearly all, so before anything that costs
      const std::int32_t n = next_reading(valid, cloud.width, i, step), neighbour = n < 0 ? -1 : map.piece[static_cast<std::size_t>(n)];
      shape.open += neighbour < 0;
      if (step != down || neighbour == piece || n == kNothing) continue;
      ++shape.foot;
      shape.foot_hidden += n == kOutside || (neighbour >= 0 && static_cast<double>(cloud.z[static_cast<std::size_t>(n)]) < p.z() - limit);
    }
  }
  const auto quantile = [&](double share) {
    const auto nth = heights.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(heights.size() - 1));
    std::nth_element(heights.begin(), nth, heights.end());
    return static_cast<double>(*nth);
  };
  shape.base_m = quantile(0.05);
  shape.top_m = quantile(0.99);
  return shape;
}

}  // namespace gfp
