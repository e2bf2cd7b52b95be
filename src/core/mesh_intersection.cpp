#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/self_intersections.hpp"

// Self-intersections: candidate pairs from a uniform grid, then edge-against-triangle tests. Two triangles cross exactly when
// an edge of one pierces the other (or they overlap in one plane); edges that start in a shared vertex cannot pierce.

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance = 1e-12;  ///< m^3 and m^2 quantities of centimetre triangles are about 1e-7.

double orient(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Does the open segment pq pass through the inside of triangle abc?
bool pierces(const Vector3d& p, const Vector3d& q, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double scale = kTolerance * 1e-3;
  const double side_p = orient(a, b, c, p), side_q = orient(a, b, c, q);
  if (!((side_p > scale && side_q < -scale) || (side_p < -scale && side_q > scale))) return false;
  const double u = orient(p, q, a, b), v = orient(p, q, b, c), w = orient(p, q, c, a);
  return (u > scale && v > scale && w > scale) || (u < -scale && v < -scale && w < -scale);
}

using Vector2d = Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Do two triangles of one plane overlap with positive area? Separating axes among their six edge normals.
bool overlap_in_plane(const Vector2d (&s)[3], const Vector2d (&t)[3]) {
  const auto separated_by_edges_of = [](const Vector2d (&first)[3], const Vector2d (&second)[3]) {
    const double turn = cross(first[1] - first[0], first[2] - first[0]) > 0 ? 1.0 : -1.0;
    for (int k = 0; k < 3; ++k) {
      const Vector2d edge = first[(k + 1) % 3] - first[k];
      bool all_outside = true;
      for (const auto& p : second) all_outside &= turn * cross(edge, p - first[k]) <= 1e-9 * edge.norm();
      if (all_outside) return true;
    }
    return false;
  };
  return !separated_by_edges_of(s, t) && !separated_by_edges_of(t, s);
}

bool coplanar_overlap(const Vector3d (&s)[3], const Vector3d (&t)[3], const Vector3d& normal) {
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  const auto flat = [drop](const Vector3d& p) {
    return drop == 0 ? Vector2d(p.y(), p.z()) : drop == 1 ? Vector2d(p.x(), p.z()) : Vector2d(p.x(), p.y());
  };
  return overlap_in_plane({flat(s[0]), flat(s[1]), flat(s[2])}, {flat(t[0]), flat(t[1]), flat(t[2])});
}

/// Unit normals; zero for slivers, which have no plane and no area to overlap with.
std::vector<Vector3d> plane_normals(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals;
  normals.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vector3d normal = (mesh.vertices[static_cast<std::size_t>(t[1])] - a).cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a);
    const double norm = normal.norm();
    normals.push_back(norm < kTolerance ? Vector3d(Vector3d::Zero()) : Vector3d(normal / norm));
  }
  return normals;
}

bool cross_each_other(const TriangleMesh& mesh, const Triangle& first, const Triangle& second, const Vector3d& normal) {
  constexpr double kOffPlane = 1e-9;
  const auto point = [&](std::int32_t v) -> const Vector3d& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  const auto has = [](const Triangle& t, std::int32_t v) { return t[0] == v || t[1] == v || t[2] == v; };
  int shared = 0, above = 0, below = 0;
  for (const std::int32_t v : second) {
    if (has(first, v)) {
      ++shared;
      continue;
    }
    const double side = normal.dot(point(v) - point(first[0]));
    above += side > kOffPlane;
    below += side < -kOffPlane;
  }
  if (shared == 3) return true;  // the same triangle twice
  if (above == 3 - shared || below == 3 - shared) return false;  // all of it on one side, or touching in what they share
  const auto edges_pierce = [&](const Triangle& edges, const Triangle& face) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = edges[k], q = edges[(k + 1) % 3];
      if (has(face, p) || has(face, q)) continue;
      if (pierces(point(p), point(q), point(face[0]), point(face[1]), point(face[2]))) return true;
    }
    return false;
  };
  if (shared < 2 && (edges_pierce(first, second) || edges_pierce(second, first))) return true;
  if (above > 0 || below > 0 || normal.isZero()) return false;
  return coplanar_overlap({point(first[0]), point(first[1]), point(first[2])}, {point(second[0]), point(second[1]), point(second[2])}, normal);
}

/// Counting-sorted lists of the triangles whose boxes touch each cell.
class TriangleGrid {
 public:
  TriangleGrid(const std::vector<Bounds>& boxes, const Bounds& all, double cell_m) : origin_(all.low), cell_(cell_m) {
    for (int axis = 0; axis < 3; ++axis)
      counts_[axis] = std::clamp(static_cast<int>(all.size()[axis] / cell_) + 1, 1, 64);
    for (int axis = 0; axis < 3; ++axis) steps_[axis] = std::max(all.size()[axis] / counts_[axis], 1e-12);
    ranges_.reserve(boxes.size());
    for (const Bounds& box : boxes) ranges_.push_back({cell_of(box.low), cell_of(box.high)});
    starts_.assign(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]) + 1, 0);
    for (const Range& range : ranges_) for_cells(range, [&](std::size_t cell) { ++starts_[cell + 1]; });
    for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
    members_.resize(static_cast<std::size_t>(starts_.back()));
    auto next = starts_;
    for (std::size_t t = 0; t < ranges_.size(); ++t)
      for_cells(ranges_[t], [&](std::size_t cell) { members_[static_cast<std::size_t>(next[cell]++)] = static_cast<std::int32_t>(t); });
  }

  std::size_t cells() const { return starts_.size() - 1; }
  std::pair<const std::int32_t*, const std::int32_t*> members(std::size_t cell) const {
    return {members_.data() + starts_[cell], members_.data() + starts_[cell + 1]};
  }

  /// The first cell that the boxes of two triangles share, where they overlap: the cell of the overlap's low corner.
  std::size_t first_shared(std::int32_t a, std::int32_t b) const {
    const Cell &one = ranges_[static_cast<std::size_t>(a)].low, &other = ranges_[static_cast<std::size_t>(b)].low;
    return index(std::max(one[0], other[0]), std::max(one[1], other[1]), std::max(one[2], other[2]));
  }

 private:
  using Cell = std::array<int, 3>;
  struct Range {
    Cell low, high;
  };

  Cell cell_of(const Vector3d& p) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] = std::clamp(static_cast<int>((p[axis] - origin_[axis]) / steps_[axis]), 0, counts_[axis] - 1);
    return cell;
  }
  std::size_t index(int x, int y, int z) const { return static_cast<std::size_t>((z * counts_[1] + y) * counts_[0] + x); }
  template <class Visit>
  void for_cells(const Range& range, Visit&& visit) const {
    for (int z = range.low[2]; z <= range.high[2]; ++z)
      for (int y = range.low[1]; y <= range.high[1]; ++y)
        for (int x = range.low[0]; x <= range.high[0]; ++x) visit(index(x, y, z));
  }

  Vector3d origin_;
  double cell_;
  int counts_[3];
  double steps_[3];
  std::vector<Range> ranges_;  ///< Of cells, per triangle.
  std::vector<std::int32_t> starts_, members_;
};

/// A box in single precision that holds the true one: what does not overlap does not touch.
struct CoarseBox {
  using Lanes = float __attribute__((vector_size(16)));
  Lanes low, high;

  explicit CoarseBox(const Bounds& box) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::nextafter(static_cast<float>(box.low[axis]), -kInfinity);
      high[axis] = std::nextafter(static_cast<float>(box.high[axis]), kInfinity);
    }
    low[3] = high[3] = 0;
  }
  bool overlaps(const CoarseBox& other) const {
    using Mask = std::int64_t __attribute__((vector_size(16)));
    const auto apart = (Mask)((low > other.high) | (other.low > high));
    return (apart[0] | apart[1]) == 0;
  }
};

/// Calls `found(a, b)` for every pair of triangles that cross, until it returns false.
template <class Found>
void visit_crossings(const TriangleMesh& mesh, Found&& found) {
  if (mesh.triangles.empty()) return;
  std::vector<Bounds> boxes(mesh.triangles.size());
  double mean_side = 0;
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const auto v : mesh.triangles[t]) boxes[t].include(mesh.vertices[static_cast<std::size_t>(v)]);
    mean_side += boxes[t].size().maxCoeff() / static_cast<double>(boxes.size());
  }
  const std::vector<Vector3d> normals = plane_normals(mesh);
  const TriangleGrid grid(boxes, bounds(mesh.vertices), std::max(mean_side, 1e-9));
  const std::vector<CoarseBox> coarse(boxes.begin(), boxes.end());
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    const auto [first, last] = grid.members(cell);
    for (auto a = first; a != last; ++a) {
      for (auto b = a + 1; b != last; ++b) {
        if (!coarse[static_cast<std::size_t>(*a)].overlaps(coarse[static_cast<std::size_t>(*b)])) continue;
        if (grid.first_shared(*a, *b) != cell) continue;  // a pair that shares several cells is looked at once
        if (!cross_each_other(mesh, mesh.triangles[static_cast<std::size_t>(*a)], mesh.triangles[static_cast<std::size_t>(*b)], normals[static_cast<std::size_t>(*a)])) continue;
        if (!found(*a, *b)) return;
      }
    }
  }
}

}  // namespace

int count_self_intersections(const TriangleMesh& mesh, int limit) {
  int count = 0;
  visit_crossings(mesh, [&](std::int32_t, std::int32_t) { return ++count < limit; });
  return count;
}

std::vector<std::array<std::int32_t, 2>> find_self_intersections(const TriangleMesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> pairs;
  visit_crossings(mesh, [&](std::int32_t a, std::int32_t b) { return pairs.push_back({a, b}), true; });
  return pairs;
}

}  // namespace gfp
