#include "gfp/core/convex_hull.hpp"

#include <algorithm>

namespace gfp {
namespace {

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

}  // namespace gfp
