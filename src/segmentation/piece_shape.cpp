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

}  // namespace

void PieceShape::add(const PieceShape& o) {
  pixels += o.pixels;
  base_m = std::min(base_m, o.base_m);
  top_m = std::max(top_m, o.top_m);
  foot += o.foot;
  foot_hidden += o.foot_hidden;
  normals += o.normals;
  point += o.point;
  normal += o.normal;
  normal_dot_point += o.normal_dot_point;
}

PieceShape piece_shape(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid, int piece,
                       const FlatSurface* support, double tolerance_m) {
  const PixelList& pixels = map.pixels[static_cast<std::size_t>(piece)];
  PieceShape shape;
  shape.pixels = static_cast<int>(pixels.size());
  const std::int32_t down = downwards(support, cloud.width);
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
    }
    const double limit = 3.0 * tolerance_m * std::max(1.0, p.z() * p.z());
    for (int step = 1; step <= kSearchPx; ++step) {
      const std::int32_t n = i + step * down;
      const bool outside = n < 0 || n >= static_cast<std::int32_t>(valid.size()) || (std::abs(down) == 1 && n / cloud.width != i / cloud.width);
      if (!outside && valid[static_cast<std::size_t>(n)] == 0) continue;
      const bool own = !outside && map.piece[static_cast<std::size_t>(n)] == piece;
      shape.foot += !own;
      shape.foot_hidden += outside || (!own && map.piece[static_cast<std::size_t>(n)] >= 0 && static_cast<double>(cloud.z[static_cast<std::size_t>(n)]) < p.z() - limit);
      break;
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
