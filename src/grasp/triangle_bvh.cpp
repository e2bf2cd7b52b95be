#include "grasp/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafTriangles = 4;
constexpr int kMaxDepth = 64;  // median splits halve: far more than any 32-bit count needs

/// Slab test of a ray against centre +- extent.
bool ray_meets_bounds(const Vector3d& centre, const Vector3d& extent, const Vector3d& origin, const Vector3d& inverse, double limit) {
  double near = 0, far = limit;
  for (int i = 0; i < 3; ++i) {
    const double t0 = (centre[i] - extent[i] - origin[i]) * inverse[i], t1 = (centre[i] + extent[i] - origin[i]) * inverse[i];
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far;
}

}  // namespace

TriangleBvh::TriangleBvh(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  const auto vertex = [&](std::int32_t i) -> const Vector3d& { return vertices[static_cast<std::size_t>(i)]; };
  std::vector<Vector3d> centres;
  centres.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) centres.push_back((vertex(a) + vertex(b) + vertex(c)) / 3.0);
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(triangles.size());
  corners_.reserve(triangles.size());
  // Bounds need corners while order_ still moves: index them by triangle first, then lay them out in leaf order.
  for (const auto& [a, b, c] : triangles) corners_.push_back({vertex(a), vertex(b), vertex(c)});
  if (!triangles.empty()) build(0, static_cast<std::int32_t>(triangles.size()), centres);
  std::vector<Corners> ordered;
  ordered.reserve(corners_.size());
  for (const std::int32_t t : order_) ordered.push_back(corners_[static_cast<std::size_t>(t)]);
  corners_ = std::move(ordered);
}

std::int32_t TriangleBvh::build(std::int32_t first, std::int32_t last, std::vector<Vector3d>& centres) {
  const auto index = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  Bounds bounds, centre_bounds;
  for (std::int32_t i = first; i < last; ++i) {
    const auto t = static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]);
    for (const Vector3d& corner : corners_[t]) bounds.include(corner);
    centre_bounds.include(centres[t]);
  }
  Node node;
  node.centre = bounds.centre();
  node.extent = 0.5 * bounds.size();
  node.first = first;
  if (last - first <= kLeafTriangles) {
    node.count = last - first;
  } else {
    int axis = 0;
    centre_bounds.size().maxCoeff(&axis);
    const std::int32_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](std::int32_t x, std::int32_t y) {
      const double a = centres[static_cast<std::size_t>(x)][axis], b = centres[static_cast<std::size_t>(y)][axis];
      return a != b ? a < b : x < y;
    });
    build(first, middle, centres);
    node.right = build(middle, last, centres);
  }
  nodes_[static_cast<std::size_t>(index)] = node;
  return index;
}

template <class Skip, class Visit>
void TriangleBvh::walk(const Skip& skip, const Visit& visit) const {
  if (nodes_.empty()) return;
  std::array<std::int32_t, kMaxDepth> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int32_t index = stack[--depth];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (skip(node)) continue;
    if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i)
      if (visit(order_[static_cast<std::size_t>(i)], corners_[static_cast<std::size_t>(i)])) return;
  }
}

void TriangleBvh::crossings(const Vector3d& origin, const Vector3d& direction, double limit_m, std::vector<Crossing>& out) const {
  out.clear();
  const Vector3d inverse = direction.cwiseInverse();
  walk([&](const Node& node) { return !ray_meets_bounds(node.centre, node.extent, origin, inverse, limit_m); },
       [&](std::int32_t triangle, const Corners& corners) {
         // Moller & Trumbore 1997, both sides.
         const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0], p = direction.cross(ac);
         const double determinant = ab.dot(p);
         if (determinant == 0) return false;
         const Vector3d s = origin - corners[0];
         const double u = s.dot(p) / determinant;
         if (u < 0 || u > 1) return false;
         const Vector3d q = s.cross(ab);
         const double v = direction.dot(q) / determinant;
         if (v < 0 || u + v > 1) return false;
         const double t = ac.dot(q) / determinant;
         if (t > 0 && t < limit_m) out.push_back({t, triangle, determinant > 0});
         return false;
       });
  std::sort(out.begin(), out.end(), [](const Crossing& x, const Crossing& y) {
    return x.distance_m != y.distance_m ? x.distance_m < y.distance_m : x.triangle < y.triangle;
  });
}

bool TriangleBvh::meets(const OrientedBox& box) const {
  bool found = false;
  walk([&](const Node& node) { return bounds_box_distance(node.centre, node.extent, box) > 0; },
       [&](std::int32_t, const Corners& corners) {
         return found = triangle_meets_box(box.T_box_world * corners[0], box.T_box_world * corners[1], box.T_box_world * corners[2], box.half);
       });
  return found;
}

double TriangleBvh::distance(const OrientedBox& box, double limit_m) const {
  double least = limit_m;
  walk([&](const Node& node) { return bounds_box_distance(node.centre, node.extent, box) >= least; },
       [&](std::int32_t, const Corners& corners) {
         least = std::min(least, triangle_box_distance(box.T_box_world * corners[0], box.T_box_world * corners[1], box.T_box_world * corners[2], box.half));
         return least == 0;
       });
  return least;
}

void TriangleBvh::gather(const OrientedBox& box, std::vector<std::int32_t>& triangles) const {
  triangles.clear();
  walk([&](const Node& node) { return bounds_box_distance(node.centre, node.extent, box) > 0; },
       [&](std::int32_t triangle, const Corners&) {
         triangles.push_back(triangle);
         return false;
       });
}

}  // namespace gfp
