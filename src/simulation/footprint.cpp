#include "simulation/footprint.hpp"

#include <algorithm>
#include <limits>

namespace gfp {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The gap from `a` to `b` beyond each edge of `a`; an edge between two points serves as both of its sides.
double gap_beyond_edges(const Polygon& a, const Polygon& b) {
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector2d edge = a[(i + 1) % a.size()] - a[i];
    const Vector2d outwards = Vector2d(edge.y(), -edge.x()).normalized();
    double gap = std::numeric_limits<double>::infinity();
    for (const Vector2d& point : b) gap = std::min(gap, outwards.dot(point - a[i]));
    best = std::max(best, gap);
  }
  return best;
}

}  // namespace

double separation(const Polygon& a, const Polygon& b) { return std::max(gap_beyond_edges(a, b), gap_beyond_edges(b, a)); }

Vector2d nearest_point(const Polygon& polygon, const Vector2d& point) {
  bool inside = polygon.size() >= 3;
  Vector2d best = polygon.front();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d edge = polygon[(i + 1) % polygon.size()] - a;
    inside = inside && cross(edge, point - a) >= 0;
    const double length2 = edge.squaredNorm();
    const double along = length2 > 0 ? std::clamp(edge.dot(point - a) / length2, 0.0, 1.0) : 0.0;
    const Vector2d candidate = a + along * edge;
    if ((candidate - point).squaredNorm() < (best - point).squaredNorm()) best = candidate;
  }
  return inside ? point : best;
}

}  // namespace gfp
