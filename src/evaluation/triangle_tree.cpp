#include "gfp/evaluation/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfp {
namespace {

constexpr std::int32_t kLeafTriangles = 4;
constexpr int kStackDepth = 64;  // median splits halve: 2^31 triangles need less than 32 levels

using Vec = Eigen::Vector3d;

double squared_distance(const Vec& point, const Vec& low, const Vec& high) {
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}

Vec closest_on_segment(const Vec& point, const Vec& a, const Vec& b) {
  const Vec ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp(ab.dot(point - a) / length2, 0.0, 1.0) : 0.0;
  return a + t * ab;
}

// Parameter t of the crossing of origin + t * direction with a triangle.
std::optional<double> crossing(const Vec& origin, const Vec& direction, const Vec& a, const Vec& b, const Vec& c) {
  const Vec ab = b - a, ac = c - a;
  const Vec p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return std::nullopt;  // parallel, or a degenerate triangle
  const double inverse = 1.0 / determinant;
  const Vec from_a = origin - a;
  const double u = from_a.dot(p) * inverse;
  if (u < 0 || u > 1) return std::nullopt;
  const Vec q = from_a.cross(ab);
  const double v = direction.dot(q) * inverse;
  if (v < 0 || u + v > 1) return std::nullopt;
  return ac.dot(q) * inverse;
}

// Whether origin + t * direction enters the box for some t in [t0, t1]. `inverse` = 1 / direction, infinities welcome.
bool enters(const Vec& origin, const Vec& inverse, const Vec& low, const Vec& high, double t0, double t1) {
  for (int axis = 0; axis < 3; ++axis) {
    const double near = (low[axis] - origin[axis]) * inverse[axis], far = (high[axis] - origin[axis]) * inverse[axis];
    // fmin and fmax pass over the NaN of 0 * infinity: a ray inside a slab's face counts as in.
    t0 = std::fmax(t0, std::fmin(near, far));
    t1 = std::fmin(t1, std::fmax(near, far));
  }
  return t0 <= t1;
}

}  // namespace

Vec closest_on_triangle(const Vec& point, const Vec& a, const Vec& b, const Vec& c) {
  const Vec normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    // Inside all three edge planes: the foot on the triangle's plane is the answer.
    const auto inside = [&](const Vec& p, const Vec& q) { return normal.cross(q - p).dot(point - p) >= 0; };
    if (inside(a, b) && inside(b, c) && inside(c, a)) return point - normal * (normal.dot(point - a) / area2);
  }
  const std::array<Vec, 3> feet{closest_on_segment(point, a, b), closest_on_segment(point, b, c), closest_on_segment(point, c, a)};
  return *std::min_element(feet.begin(), feet.end(),
                           [&](const Vec& p, const Vec& q) { return (p - point).squaredNorm() < (q - point).squaredNorm(); });
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corner = mesh.triangles[t];
    triangles_.push_back({mesh.vertices[static_cast<std::size_t>(corner[0])], mesh.vertices[static_cast<std::size_t>(corner[1])],
                          mesh.vertices[static_cast<std::size_t>(corner[2])], static_cast<std::int32_t>(t)});
  }
  if (triangles_.empty()) return;
  nodes_.reserve(triangles_.size());
  build(0, static_cast<std::int32_t>(triangles_.size()));
}

void TriangleTree::build(std::int32_t first, std::int32_t count) {
  const std::size_t self = nodes_.size();
  Bounds box, centres;
  for (std::int32_t i = first; i < first + count; ++i) {
    const Packed& t = triangles_[static_cast<std::size_t>(i)];
    for (const Vec* corner : {&t.a, &t.b, &t.c}) box.include(*corner);
    centres.include(t.a + t.b + t.c);
  }
  nodes_.push_back({box.low, box.high, first, count});
  if (count <= kLeafTriangles) return;
  Eigen::Index axis = 0;
  centres.size().maxCoeff(&axis);
  const std::int32_t half = count / 2;
  const auto centre = [axis](const Packed& t) { return t.a[axis] + t.b[axis] + t.c[axis]; };
  std::nth_element(triangles_.begin() + first, triangles_.begin() + first + half, triangles_.begin() + first + count,
                   [&](const Packed& s, const Packed& t) {
                     const double cs = centre(s), ct = centre(t);
                     return cs < ct || (cs == ct && s.index < t.index);  // a total order: the tree is the same everywhere
                   });
  build(first, half);
  nodes_[self].first = static_cast<std::int32_t>(nodes_.size());
  nodes_[self].count = 0;
  build(first + half, count - half);
}

TriangleTree::Closest TriangleTree::closest(const Vec& point, double reach_m) const {
  Closest best;
  if (nodes_.empty()) return best;
  double best2 = reach_m * reach_m;
  struct Visit {
    std::int32_t node;
    double distance2;
  };
  std::array<Visit, kStackDepth> stack;
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = {0, squared_distance(point, nodes_[0].low, nodes_[0].high)};
  while (depth > 0) {
    const Visit visit = stack[static_cast<std::size_t>(--depth)];
    if (visit.distance2 > best2) continue;
    const Node& node = nodes_[static_cast<std::size_t>(visit.node)];
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const Packed& t = triangles_[static_cast<std::size_t>(i)];
      const Vec foot = closest_on_triangle(point, t.a, t.b, t.c);
      const double distance2 = (foot - point).squaredNorm();
      if (distance2 > best2 || (distance2 == best2 && best.triangle >= 0)) continue;
      best2 = distance2;
      best = {0, t.index, foot};
    }
    if (node.count > 0) continue;
    const std::int32_t left = visit.node + 1, right = node.first;
    const auto box = [&](std::int32_t n) {
      return squared_distance(point, nodes_[static_cast<std::size_t>(n)].low, nodes_[static_cast<std::size_t>(n)].high);
    };
    Visit near{left, box(left)}, far{right, box(right)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    stack[static_cast<std::size_t>(depth++)] = far;
    stack[static_cast<std::size_t>(depth++)] = near;
  }
  if (best.triangle >= 0) best.distance_m = std::sqrt(best2);
  return best;
}

bool TriangleTree::blocks(const Vec& from, const Vec& to) const {
  if (nodes_.empty()) return false;
  const Vec direction = to - from, inverse = direction.cwiseInverse();
  std::array<std::int32_t, kStackDepth> stack{0};
  int depth = 1;
  while (depth > 0) {
    const std::int32_t index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!enters(from, inverse, node.low, node.high, 0.0, 1.0)) continue;
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const Packed& t = triangles_[static_cast<std::size_t>(i)];
      const auto s = crossing(from, direction, t.a, t.b, t.c);
      if (s && *s > 0 && *s < 1) return true;
    }
    if (node.count > 0) continue;
    stack[static_cast<std::size_t>(depth++)] = node.first;
    stack[static_cast<std::size_t>(depth++)] = index + 1;
  }
  return false;
}

std::optional<double> TriangleTree::crossing_along(const Vec& origin, const Vec& direction, double reach_m) const {
  if (nodes_.empty()) return std::nullopt;
  const Vec inverse = direction.cwiseInverse();
  std::optional<double> best;
  double reach = reach_m;
  std::array<std::int32_t, kStackDepth> stack{0};
  int depth = 1;
  while (depth > 0) {
    const std::int32_t index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!enters(origin, inverse, node.low, node.high, -reach, reach)) continue;
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const Packed& t = triangles_[static_cast<std::size_t>(i)];
      if ((t.b - t.a).cross(t.c - t.a).dot(direction) <= 0) continue;
      const auto s = crossing(origin, direction, t.a, t.b, t.c);
      if (!s || std::abs(*s) > reach || (best && std::abs(*s) == reach)) continue;
      best = *s;
      reach = std::abs(*s);
    }
    if (node.count > 0) continue;
    stack[static_cast<std::size_t>(depth++)] = node.first;
    stack[static_cast<std::size_t>(depth++)] = index + 1;
  }
  return best;
}

}  // namespace gfp
