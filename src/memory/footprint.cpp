#include "memory/footprint.hpp"

#include <algorithm>
#include <cstddef>

namespace gfp {
namespace {

constexpr std::size_t kFootprintSamples = 2000;  // an outline needs no more

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Walks sorted points and keeps those where the walk turns left.
template <class Iterator>
std::vector<Eigen::Vector2d> left_chain(Iterator first, Iterator last) {
  std::vector<Eigen::Vector2d> chain;
  for (; first != last; ++first) {
    while (chain.size() >= 2 && turn(chain[chain.size() - 2], chain.back(), *first) <= 0) chain.pop_back();
    chain.push_back(*first);
  }
  return chain;
}

}  // namespace

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  const auto by_xy = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), by_xy);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull = left_chain(points.begin(), points.end());
  const std::vector<Eigen::Vector2d> upper = left_chain(points.rbegin(), points.rend());
  hull.insert(hull.end(), upper.begin() + 1, upper.end() - 1);  // both chains hold both ends
  return hull;
}

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
