#include "memory/footprint.hpp"

#include <algorithm>
#include <cstddef>

#include "gfp/core/convex_hull.hpp"

namespace gfp {
namespace {

constexpr std::size_t kFootprintSamples = 2000;  // an outline needs no more

}  // namespace

std::vector<Eigen::Vector2d> footprint(const Segment& segment, const OrganizedCloud& cloud, const Transform& T_camera_support) {
  const Transform T_support_camera = T_camera_support.inverse();
  const std::size_t stride = std::max<std::size_t>(1, segment.pixels.size() / kFootprintSamples);
  std::vector<Eigen::Vector2d> points;
  points.reserve(segment.pixels.size() / stride + 1);
  for (std::size_t i = 0; i < segment.pixels.size(); i += stride) {
    const auto pixel = static_cast<std::size_t>(segment.pixels[i]);
    if (cloud.valid(pixel)) points.push_back((T_support_camera * cloud.point(pixel).cast<double>()).head<2>());
  }
  return convex_hull(std::move(points));
}

}  // namespace gfp
