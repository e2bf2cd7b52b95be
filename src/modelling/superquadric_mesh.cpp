#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gfp/modelling/superquadric.hpp"
#include "gfp/primitive/content_hash.hpp"
#include "modelling/superquadric_norm.hpp"

// The mesh is Barr's spherical product: rings are shrunken copies of one convex polygon (a superellipse in x, y), stacked along
// z by a convex profile (another superellipse). Quads between rings are planar trapezoids, so no triangle can cross another,
// whatever the parameters. Each quarter of a superellipse is split at its corner (the diagonal), and both halves are sampled at
// about equal arcs: where exponents are small, the corner itself is a vertex and nothing is cut off.

namespace gfp {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kQuarterMeridians = 8;  ///< Steps along a quarter of a ring.
constexpr int kQuarterRings = 10;     ///< Steps from pole to equator.
constexpr int kMeridians = 4 * kQuarterMeridians;
constexpr int kRings = 2 * kQuarterRings - 1;
constexpr int kVertices = kMeridians * kRings + 2;

/// Point of the unit superellipse in direction `angle` of its first quadrant.
Vector2d on_superellipse(double angle, double p) {
  const Vector2d direction(std::cos(angle), std::sin(angle));
  return direction / p_norm(std::max(0.0, direction.x()), std::max(0.0, direction.y()), p).value;
}

/// Points [first, last) of a quarter are filled: `count` equal arcs from angle `from` to angle `to`, measured after scaling by (a, b).
struct Arc {
  double length = 0;
  std::array<double, 33> along{};  ///< Arc length at each of the equal steps in angle.
};

Arc measure_arc(double from, double to, double p, const Vector2d& scale) {
  Arc arc;
  Vector2d before = on_superellipse(from, p).cwiseProduct(scale);
  for (std::size_t k = 1; k < arc.along.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(arc.along.size() - 1);
    const Vector2d here = on_superellipse(from + share * (to - from), p).cwiseProduct(scale);
    arc.length += (here - before).norm();
    arc.along[k] = arc.length;
    before = here;
  }
  return arc;
}

double angle_at(const Arc& arc, double from, double to, double length) {
  std::size_t k = 1;
  while (k + 1 < arc.along.size() && arc.along[k] < length) ++k;
  const double part = (length - arc.along[k - 1]) / std::max(arc.along[k] - arc.along[k - 1], 1e-300);
  return from + (static_cast<double>(k - 1) + part) / static_cast<double>(arc.along.size() - 1) * (to - from);
}

/// `steps` + 1 points of a quarter from (1, 0) to (0, 1), exact at both ends and at the corner.
template <std::size_t kPoints>
std::array<Vector2d, kPoints> sample_quarter(double epsilon, const Vector2d& scale) {
  constexpr double kCorner = std::numbers::pi / 4, kEnd = std::numbers::pi / 2;
  constexpr int kSteps = static_cast<int>(kPoints) - 1;
  const double p = 2 / epsilon;
  const Arc first = measure_arc(0, kCorner, p, scale), second = measure_arc(kCorner, kEnd, p, scale);
  const double share = first.length / (first.length + second.length);
  const int split = std::clamp(static_cast<int>(std::lround(share * kSteps)), 1, kSteps - 1);
  std::array<Vector2d, kPoints> points;
  for (int k = 0; k <= kSteps; ++k) {
    const bool before = k <= split;
    const double length = before ? first.length * k / split : second.length * (k - split) / (kSteps - split);
    const double angle = before ? angle_at(first, 0, kCorner, length) : angle_at(second, kCorner, kEnd, length);
    points[static_cast<std::size_t>(k)] = on_superellipse(angle, p);
  }
  points.front() = {1, 0};
  points.back() = {0, 1};
  return points;
}

std::vector<Triangle> sphere_triangles() {
  const auto at = [](int ring, int meridian) { return static_cast<std::int32_t>(ring * kMeridians + meridian % kMeridians); };
  constexpr std::int32_t kBottom = kVertices - 2, kTop = kVertices - 1;
  std::vector<Triangle> triangles;
  for (int m = 0; m < kMeridians; ++m) {
    triangles.push_back({kBottom, at(0, m + 1), at(0, m)});
    for (int r = 0; r + 1 < kRings; ++r) {
      triangles.push_back({at(r, m), at(r, m + 1), at(r + 1, m + 1)});
      triangles.push_back({at(r, m), at(r + 1, m + 1), at(r + 1, m)});
    }
    triangles.push_back({kTop, at(kRings - 1, m), at(kRings - 1, m + 1)});
  }
  return triangles;
}

}  // namespace

std::shared_ptr<const Topology> superquadric_topology() {
  static const std::shared_ptr<const Topology> shared = [] {
    auto topology = std::make_shared<Topology>();
    topology->triangles = sphere_triangles();
    topology->filled_triangles = topology->triangles;
    topology->types.assign(kVertices, PointType::kRegular);
    topology->parts.assign(kVertices, Part::kBody);
    topology->hash = topology_hash(*topology);
    return topology;
  }();
  return shared;
}

std::vector<Vector3d> superquadric_vertices(const Superquadric& superquadric) {
  const Vector3d& a = superquadric.half_axes_m;
  // Square roots: half way between equal arcs in metres, which starve the short side of a long body, and equal arcs of the unit shape.
  const auto outline = sample_quarter<kQuarterMeridians + 1>(superquadric.epsilon2, {std::sqrt(a.x()), std::sqrt(a.y())});
  const auto profile = sample_quarter<kQuarterRings + 1>(superquadric.epsilon1, {std::sqrt(0.5 * (a.x() + a.y())), std::sqrt(a.z())});
  std::vector<Vector3d> vertices;
  vertices.reserve(kVertices);
  const auto add = [&](const Vector3d& unit) { vertices.push_back(superquadric.pose * unit.cwiseProduct(a)); };
  for (int ring = -(kQuarterRings - 1); ring < kQuarterRings; ++ring) {
    const Vector2d& at = profile[static_cast<std::size_t>(std::abs(ring))];
    for (int m = 0; m < kMeridians; ++m) {
      const int quarter = m / kQuarterMeridians, step = m % kQuarterMeridians;
      const Vector2d& corner = outline[static_cast<std::size_t>(quarter % 2 == 0 ? step : kQuarterMeridians - step)];
      const double x = quarter == 1 || quarter == 2 ? -corner.x() : corner.x(), y = quarter >= 2 ? -corner.y() : corner.y();
      add({at.x() * x, at.x() * y, ring < 0 ? -at.y() : at.y()});
    }
  }
  add({0, 0, -1});
  add({0, 0, 1});
  return vertices;
}

}  // namespace gfp
