#include "core/decimate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kLeastTurnCosine = 0.5;  ///< Of a triangle's normal before and after.
constexpr double kLeastShape = 0.08;      ///< Of a triangle that changed: 1 for an equilateral one, 0 for a needle; or as bad as before.
constexpr double kEvenness = 1e-3;        ///< What an edge's length adds to the cost: on flat faces the short ones go first.

double shape_quality(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return sides > 0 ? 2 * std::sqrt(3.0) * (b - a).cross(c - a).norm() / sides : 0.0;
}

/// Area-weighted squared distance to planes: x^T A x + 2 b x + c.
struct Quadric {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double c = 0, area = 0;

  void add_plane(const Vector3d& normal, double offset, double weight) {
    A += weight * normal * normal.transpose();
    b += weight * offset * normal;
    c += weight * offset * offset;
    area += weight;
  }
  void add(const Quadric& other) { A += other.A, b += other.b, c += other.c, area += other.area; }
  double at(const Vector3d& x) const { return std::max(0.0, x.dot(A * x) + 2 * b.dot(x) + c); }
};

class Decimation {
 public:
  Decimation(const TriangleMesh& mesh, double longest_edge_m, std::vector<std::uint8_t> locked)
      : points_(mesh.vertices), triangles_(mesh.triangles), fans_(points_.size()), quadrics_(points_.size()), stamps_(points_.size(), 0), marks_(points_.size(), 0), locked_(std::move(locked)),
        left_(static_cast<int>(points_.size())), longest_squared_(longest_edge_m * longest_edge_m) {
    const Vector3d origin = bounds(points_).centre();
    for (Vector3d& p : points_) p -= origin;  // quadrics cancel far from the origin
    origin_ = origin;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Vector3d scaled_normal = normal_of(triangles_[t]);
      const double twice_area = scaled_normal.norm();
      const Vector3d normal = twice_area > 0 ? Vector3d(scaled_normal / twice_area) : Vector3d(Vector3d::Zero());
      for (const auto v : triangles_[t]) {
        fans_[at(v)].push_back(static_cast<std::int32_t>(t));
        quadrics_[at(v)].add_plane(normal, -normal.dot(point(v)), twice_area / 6);
      }
    }
  }

  TriangleMesh run(int vertices) {
    for (std::size_t v = 0; v < points_.size(); ++v) consider(static_cast<std::int32_t>(v));
    while (left_ > vertices && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (best.stamp == stamps_[at(best.from)]) collapse(best.from, best.to);
    }
    return result();
  }

 private:
  struct Candidate {
    double cost;
    std::int32_t from, to;
    int stamp;
    bool operator<(const Candidate& other) const { return cost != other.cost ? cost > other.cost : from > other.from; }  // the cheapest is on top
  };

  static std::size_t at(std::int32_t v) { return static_cast<std::size_t>(v); }
  const Vector3d& point(std::int32_t v) const { return points_[at(v)]; }
  Vector3d normal_of(const Triangle& t) const { return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0])); }

  /// Neighbours by edge, in the order of the fan's triangles.
  void neighbours(std::int32_t v, std::vector<std::int32_t>& out) {
    out.clear();
    ++mark_;
    for (const auto t : fans_[at(v)])
      for (const auto w : triangles_[at(t)])
        if (w != v && marks_[at(w)] != mark_) marks_[at(w)] = mark_, out.push_back(w);
  }

  /// Queues the vertex's cheapest allowed collapse.
  void consider(std::int32_t from) {
    const int stamp = ++stamps_[at(from)];
    if (!locked_.empty() && locked_[at(from)] != 0) return;
    neighbours(from, ring_);
    ranked_.clear();
    for (const auto to : ring_) {
      const double even = kEvenness * quadrics_[at(from)].area * (point(from) - point(to)).squaredNorm();
      ranked_.emplace_back(quadrics_[at(from)].at(point(to)) + quadrics_[at(to)].at(point(to)) + even, to);
    }
    std::sort(ranked_.begin(), ranked_.end());
    for (const auto& [cost, to] : ranked_) {
      if (!allowed(from, to)) continue;
      queue_.push({cost, from, to, stamp});
      return;
    }
  }

  bool allowed(std::int32_t from, std::int32_t to) {
    const Vector3d& target = point(to);
    for (const auto w : ring_)
      if (w != to && (point(w) - target).squaredNorm() > longest_squared_) return false;
    neighbours(to, other_ring_);  // leaves its marks: the link condition is two neighbours in common
    int common = 0;
    for (const auto w : ring_) common += marks_[at(w)] == mark_;
    if (common != 2 || (ring_.size() <= 3 && other_ring_.size() <= 3)) return false;
    for (const auto index : fans_[at(from)]) {
      const Triangle& t = triangles_[at(index)];
      if (t[0] == to || t[1] == to || t[2] == to) continue;
      Triangle moved = t;
      for (auto& v : moved)
        if (v == from) v = to;
      const Vector3d before = normal_of(t), after = normal_of(moved);
      if (before.dot(after) < kLeastTurnCosine * before.norm() * after.norm()) return false;
      const double quality = shape_quality(point(moved[0]), point(moved[1]), point(moved[2]));
      if (quality < kLeastShape && quality < shape_quality(point(t[0]), point(t[1]), point(t[2]))) return false;
      if (after.squaredNorm() <= 0) return false;
    }
    return true;
  }

  void collapse(std::int32_t from, std::int32_t to) {
    for (const auto index : fans_[at(from)]) {
      Triangle& t = triangles_[at(index)];
      if (t[0] == to || t[1] == to || t[2] == to) {
        for (const auto v : t)
          if (v != from) std::erase(fans_[at(v)], index);
        t = {-1, -1, -1};
        continue;
      }
      for (auto& v : t)
        if (v == from) v = to;
      fans_[at(to)].push_back(index);
    }
    fans_[at(from)].clear();
    ++stamps_[at(from)];
    quadrics_[at(to)].add(quadrics_[at(from)]);
    --left_;
    std::vector<std::int32_t> around;
    neighbours(to, around);
    consider(to);
    for (const auto w : around) consider(w);
  }

  TriangleMesh result() const {
    TriangleMesh mesh;
    std::vector<std::int32_t> place(points_.size(), -1);
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (fans_[v].empty()) continue;
      place[v] = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.push_back(points_[v] + origin_);
    }
    for (const Triangle& t : triangles_)
      if (t[0] >= 0) mesh.triangles.push_back({place[at(t[0])], place[at(t[1])], place[at(t[2])]});
    return mesh;
  }

  std::vector<Vector3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::int32_t>> fans_;  ///< Triangles of every vertex; empty: it is gone.
  std::vector<Quadric> quadrics_;
  std::vector<int> stamps_, marks_;
  std::vector<std::uint8_t> locked_;
  int mark_ = 0, left_;
  double longest_squared_;
  Vector3d origin_;
  std::priority_queue<Candidate> queue_;
  std::vector<std::int32_t> ring_, other_ring_;
  std::vector<std::pair<double, std::int32_t>> ranked_;
};

}  // namespace

TriangleMesh decimated(const TriangleMesh& mesh, int vertices, double longest_edge_m, std::vector<std::uint8_t> locked) {
  return Decimation(mesh, longest_edge_m, std::move(locked)).run(vertices);
}

}  // namespace gfp
