#include "grasp/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "grasp/bvh_kernels.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafTriangles = 4;
constexpr double kSlack = 1e-9;      // metres: rounding must not lose what lies in a box's face
constexpr std::size_t kStack = 128;  // quartering splits: three waiting siblings a level

/// A box's transform as the kernels want it.
struct BoxView {
  explicit BoxView(const OrientedBox& box) : half(box.half), translation(box.T_box_world.translation()), rotation(box.T_box_world.linear()) {}
  Vector3d half, translation;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation;
};

/// One triangle of a leaf in box coordinates.
struct LocalTriangle {
  Vector3d a, b, c;
};

/// The leaf's triangles in box coordinates, one at a time, until `visit` returns true.
template <class Visit>
bool any_local_triangle(const TriangleBvh::Leaf& leaf, const BoxView& box, const Visit& visit) {
  double corners[3][3][4];
  corners_in_box(leaf, box.rotation.data(), box.translation.data(), corners);
  for (int i = 0; i < leaf.count; ++i) {
    const auto at = [&](int corner) { return Vector3d(corners[corner][0][i], corners[corner][1][i], corners[corner][2][i]); };
    if (visit(LocalTriangle{at(0), at(1), at(2)})) return true;
  }
  return false;
}

}  // namespace

/// What only construction needs: corners and centres by triangle, and the order that the splits make.
struct TriangleBvh::Build {
  std::vector<std::array<Vector3d, 3>> corners;
  std::vector<Vector3d> centres;
  std::vector<std::int32_t> order;
  std::vector<std::pair<double, std::int32_t>> keys;  // of one split

  std::size_t triangle(std::int32_t place) const { return static_cast<std::size_t>(order[static_cast<std::size_t>(place)]); }

  /// Halves [first, last) at the median along the longest axis of its centres.
  std::int32_t split(std::int32_t first, std::int32_t last) {
    Bounds spread;
    for (std::int32_t i = first; i < last; ++i) spread.include(centres[triangle(i)]);
    int axis = 0;
    spread.size().maxCoeff(&axis);
    keys.clear();
    for (std::int32_t i = first; i < last; ++i) keys.emplace_back(centres[triangle(i)][axis], order[static_cast<std::size_t>(i)]);
    const std::int32_t middle = first + (last - first) / 2;
    std::nth_element(keys.begin(), keys.begin() + (middle - first), keys.end());
    std::transform(keys.begin(), keys.end(), order.begin() + first, [](const auto& key) { return key.second; });
    return middle;
  }
};

TriangleBvh::TriangleBvh(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) return;
  const auto vertex = [&](std::int32_t i) -> const Vector3d& { return vertices[static_cast<std::size_t>(i)]; };
  Build build;
  build.corners.reserve(triangles.size());
  build.centres.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    build.corners.push_back({vertex(a), vertex(b), vertex(c)});
    build.centres.push_back((vertex(a) + vertex(b) + vertex(c)) / 3.0);
  }
  build.order.resize(triangles.size());
  std::iota(build.order.begin(), build.order.end(), 0);
  nodes_.reserve(triangles.size() / 4 + 1);
  leaves_.reserve(triangles.size() / 2 + 1);
  add_node(build, 0, static_cast<std::int32_t>(triangles.size()));
}

std::int32_t TriangleBvh::add_node(Build& build, std::int32_t first, std::int32_t last) {
  const auto index = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  std::array<std::int32_t, 5> cuts{first, last, last, last, last};
  if (last - first > kLeafTriangles) {
    const std::int32_t middle = build.split(first, last);
    cuts = {first, build.split(first, middle), middle, build.split(middle, last), last};
  }
  Node node;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const std::int32_t low = cuts[lane], high = cuts[lane + 1];
    Bounds box;
    for (std::int32_t i = low; i < high; ++i)
      for (const Vector3d& corner : build.corners[build.triangle(i)]) box.include(corner);
    for (int axis = 0; axis < 3; ++axis) {
      node.centre[axis][lane] = low < high ? box.centre()[axis] : 0;
      node.extent[axis][lane] = low < high ? 0.5 * box.size()[axis] + kSlack : -1e200;
    }
    node.child[lane] = low >= high ? kNone : high - low <= kLeafTriangles ? ~add_leaf(build, low, high) : add_node(build, low, high);
  }
  nodes_[static_cast<std::size_t>(index)] = node;
  return index;
}

std::int32_t TriangleBvh::add_leaf(const Build& build, std::int32_t first, std::int32_t last) {
  Leaf leaf{};
  leaf.count = last - first;
  for (std::int32_t i = 0; i < kLeafTriangles; ++i) {
    const std::size_t triangle = build.triangle(std::min(first + i, last - 1));
    const auto& [a, b, c] = build.corners[triangle];
    leaf.triangle[i] = static_cast<std::int32_t>(triangle);
    for (int axis = 0; axis < 3; ++axis) {
      leaf.corner[axis][i] = a[axis];
      leaf.edge1[axis][i] = b[axis] - a[axis];
      leaf.edge2[axis][i] = c[axis] - a[axis];
    }
  }
  leaves_.push_back(leaf);
  return static_cast<std::int32_t>(leaves_.size()) - 1;
}

template <class Measure, class Limit, class Visit>
void TriangleBvh::walk(const Measure& measure, const Limit& limit, const Visit& visit) const {
  if (nodes_.empty()) return;
  std::array<std::int32_t, kStack> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int32_t entry = stack[--depth];
    if (entry < 0) {
      if (visit(leaves_[static_cast<std::size_t>(~entry)])) return;
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry)];
    double values[4];
    measure(node, values);
    for (int lane = 3; lane >= 0; --lane)
      if (values[lane] <= limit() && node.child[lane] != kNone) stack[depth++] = node.child[lane];
  }
}

void TriangleBvh::crossings(const Vector3d& origin, const Vector3d& direction, double limit_m, std::vector<Crossing>& out) const {
  out.clear();
  Vector3d inverse;  // finite, so that a ray inside a face of a box gives 0, not 0 * infinity
  for (int axis = 0; axis < 3; ++axis) inverse[axis] = 1.0 / (std::abs(direction[axis]) > 1e-15 ? direction[axis] : 1e-15);
  walk([&](const Node& node, double* entry) { ray_to_boxes(node, origin.data(), inverse.data(), entry); }, [&] { return limit_m; },
       [&](const Leaf& leaf) {
         double distance[4], determinant[4];
         ray_to_triangles(leaf, origin.data(), direction.data(), distance, determinant);
         for (int i = 0; i < leaf.count; ++i)
           if (distance[i] > 0 && distance[i] < limit_m) out.push_back({distance[i], leaf.triangle[i], determinant[i] > 0});
         return false;
       });
  std::sort(out.begin(), out.end(), [](const Crossing& x, const Crossing& y) {
    return x.distance_m != y.distance_m ? x.distance_m < y.distance_m : x.triangle < y.triangle;
  });
}

bool TriangleBvh::meets(const OrientedBox& box) const {
  const BoxView view(box);
  bool found = false;
  walk([&](const Node& node, double* squared) { box_to_boxes(node, view.rotation.data(), view.translation.data(), view.half.data(), squared); },
       [] { return 0.0; },
       [&](const Leaf& leaf) {
         return found = any_local_triangle(leaf, view, [&](const LocalTriangle& t) { return triangle_meets_box(t.a, t.b, t.c, view.half); });
       });
  return found;
}

double TriangleBvh::distance(const OrientedBox& box, double limit_m) const {
  const BoxView view(box);
  double least = limit_m;
  walk([&](const Node& node, double* squared) { box_to_boxes(node, view.rotation.data(), view.translation.data(), view.half.data(), squared); },
       [&] { return least * least; },
       [&](const Leaf& leaf) {
         return any_local_triangle(leaf, view, [&](const LocalTriangle& t) {
           least = std::min(least, triangle_box_distance(t.a, t.b, t.c, view.half));
           return least == 0;
         });
       });
  return least;
}

void TriangleBvh::gather(const OrientedBox& box, std::vector<std::int32_t>& triangles) const {
  const BoxView view(box);
  triangles.clear();
  walk([&](const Node& node, double* squared) { box_to_boxes(node, view.rotation.data(), view.translation.data(), view.half.data(), squared); },
       [] { return 0.0; },
       [&](const Leaf& leaf) {
         triangles.insert(triangles.end(), leaf.triangle, leaf.triangle + leaf.count);
         return false;
       });
}

}  // namespace gfp
