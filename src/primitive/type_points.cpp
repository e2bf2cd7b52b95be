#include "gfp/primitive/type_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <queue>

namespace gfp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

class Typing {
 public:
  Typing(const TriangleMesh& mesh, const TypePointsOptions& options)
      : mesh_(mesh), options_(options), adjacency_(vertex_adjacency(mesh)), edge_(mean_edge_length(mesh)), control_(mesh.vertices.size(), false) {}

  PointTyping run() {
    find_feature_edges();
    const auto corners = find_corners();
    mark_widest_boundary();
    mark_arcs(corners);
    const auto peaks = curvature_extremes();
    mark(corners);
    mark(peaks);
    mark_axis_extremes();
    fill();
    PointTyping typing;
    typing.features = static_cast<int>(corners.size() + peaks.size());
    for (const bool control : control_) typing.types.push_back(control ? PointType::kControl : PointType::kRegular);
    return typing;
  }

 private:
  using Vertices = std::vector<std::int32_t>;

  const Eigen::Vector3d& at(std::int32_t v) const { return mesh_.vertices[index(v)]; }
  double length(std::int32_t a, std::int32_t b) const { return (at(a) - at(b)).norm(); }

  template <class Visit>
  void neighbours(std::int32_t v, Visit&& visit) const {
    for (auto k = adjacency_.offsets[index(v)]; k < adjacency_.offsets[index(v) + 1]; ++k) visit(adjacency_.indices[index(k)]);
  }

  void mark(const Vertices& vertices) {
    for (const auto v : vertices) control_[index(v)] = true;
  }

  void find_feature_edges() {
    const auto normals = triangle_normals(mesh_);
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> first;  // edge -> the triangle met first
    features_.assign(mesh_.vertices.size(), {});
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
        const auto [entry, fresh] = first.try_emplace({std::min(a, b), std::max(a, b)}, t);
        if (fresh || std::acos(std::clamp(normals[t].dot(normals[entry->second]), -1.0, 1.0)) < options_.feature_dihedral_rad) continue;
        features_[index(a)].push_back(b);
        features_[index(b)].push_back(a);
      }
    }
  }

  /// (a)
  Vertices find_corners() const {
    Vertices corners;
    for (std::size_t v = 0; v < features_.size(); ++v) {
      const auto& ends = features_[v];
      if (ends.empty()) continue;
      const Eigen::Vector3d& p = mesh_.vertices[v];
      const bool smooth = ends.size() == 2 && (p - at(ends[0])).normalized().dot((at(ends[1]) - p).normalized()) > std::cos(options_.corner_turn_rad);
      if (!smooth) corners.push_back(static_cast<std::int32_t>(v));
    }
    return corners;
  }

  /// (b)
  void mark_widest_boundary() {
    const Bounds box = bounds(mesh_.vertices);
    Eigen::Index widest = 0;
    const double margin = options_.extreme_share * box.size().maxCoeff(&widest);
    for (std::size_t v = 0; v < control_.size(); ++v) {
      const double along = mesh_.vertices[v][widest];
      if (along < box.low[widest] + margin || along > box.high[widest] - margin) control_[v] = true;
    }
  }

  /// (c) Walks every chain of feature edges from its corners; closed chains without one from their lowest index.
  void mark_arcs(const Vertices& corners) {
    std::vector<bool> corner(mesh_.vertices.size(), false), walked(mesh_.vertices.size(), false);
    for (const auto v : corners) corner[index(v)] = true;
    for (const auto v : corners)
      for (const auto next : features_[index(v)]) walk(v, next, corner, walked);
    for (std::size_t v = 0; v < features_.size(); ++v) {
      if (features_[v].empty() || corner[v] || walked[v]) continue;
      control_[v] = walked[v] = true;
      walk(static_cast<std::int32_t>(v), features_[v][0], corner, walked);
    }
  }

  void walk(std::int32_t from, std::int32_t to, const std::vector<bool>& corner, std::vector<bool>& walked) {
    double since = 0;
    while (!corner[index(to)] && !walked[index(to)]) {
      walked[index(to)] = true;
      since += length(from, to);
      if (since >= (options_.arc_spacing_edges - 0.5) * edge_) {
        control_[index(to)] = true;
        since = 0;
      }
      const auto& ends = features_[index(to)];
      const auto next = ends[0] == from ? ends[1] : ends[0];
      from = to;
      to = next;
    }
  }

  /// (d) |Laplacian| over the mean edge, as a cheap mean curvature; extremes within two edges, ties to the lower index.
  Vertices curvature_extremes() const {
    const auto normals = vertex_normals(mesh_);
    std::vector<double> bend(mesh_.vertices.size());
    for (std::size_t v = 0; v < bend.size(); ++v) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weight = 0;
      neighbours(static_cast<std::int32_t>(v), [&](std::int32_t n) {
        const double w = 1.0 / std::max(length(static_cast<std::int32_t>(v), n), 1e-12);
        sum += w * (at(n) - mesh_.vertices[v]);
        weight += w;
      });
      bend[v] = weight > 0 ? std::abs(sum.dot(normals[v])) / weight / edge_ : 0;
    }
    Vertices peaks;
    for (std::size_t v = 0; v < bend.size(); ++v)
      if (bend[v] > options_.min_curvature && is_peak(static_cast<std::int32_t>(v), bend)) peaks.push_back(static_cast<std::int32_t>(v));
    return peaks;
  }

  bool is_peak(std::int32_t v, const std::vector<double>& value) const {
    bool peak = true;
    const auto lower = [&](std::int32_t n) { return n == v || value[index(n)] < value[index(v)] || (value[index(n)] == value[index(v)] && n > v); };
    neighbours(v, [&](std::int32_t n) {
      peak = peak && lower(n);
      neighbours(n, [&](std::int32_t far) { peak = peak && lower(far); });
    });
    return peak;
  }

  void mark_axis_extremes() {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto less = [axis](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return p[axis] < q[axis]; };
      const auto [low, high] = std::minmax_element(mesh_.vertices.begin(), mesh_.vertices.end(), less);
      for (const auto extreme : {low, high}) control_[static_cast<std::size_t>(extreme - mesh_.vertices.begin())] = true;
    }
  }

  /// (e) Distances along edges from all controls, then from one more at the farthest vertex, until none is far.
  void fill() {
    std::vector<double> distance(control_.size(), kInfinity);
    std::vector<std::int32_t> sources;
    for (std::size_t v = 0; v < control_.size(); ++v)
      if (control_[v]) sources.push_back(static_cast<std::int32_t>(v));
    spread(sources, distance);
    while (true) {
      const auto farthest = std::max_element(distance.begin(), distance.end());
      if (*farthest <= options_.fill_radius_edges * edge_) return;
      const auto v = static_cast<std::int32_t>(farthest - distance.begin());
      control_[index(v)] = true;
      spread({v}, distance);
    }
  }

  /// Dijkstra that only lowers `distance`.
  void spread(const Vertices& sources, std::vector<double>& distance) const {
    using Entry = std::pair<double, std::int32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const auto v : sources) {
      distance[index(v)] = 0;
      queue.emplace(0, v);
    }
    while (!queue.empty()) {
      const auto [d, v] = queue.top();
      queue.pop();
      if (d > distance[index(v)]) continue;
      neighbours(v, [&](std::int32_t n) {
        const double candidate = d + length(v, n);
        if (candidate >= distance[index(n)]) return;
        distance[index(n)] = candidate;
        queue.emplace(candidate, n);
      });
    }
  }

  const TriangleMesh& mesh_;
  const TypePointsOptions& options_;
  VertexAdjacency adjacency_;
  double edge_;
  std::vector<bool> control_;
  std::vector<Vertices> features_;  ///< Per vertex: other ends of its feature edges.
};

}  // namespace

PointTyping type_points(const TriangleMesh& mesh, const TypePointsOptions& options) { return Typing(mesh, options).run(); }

std::vector<PointType> with_manual_types(std::vector<PointType> automatic, const std::vector<std::optional<PointType>>& manual) {
  for (std::size_t v = 0; v < std::min(automatic.size(), manual.size()); ++v)
    if (manual[v]) automatic[v] = *manual[v];
  return automatic;
}

}  // namespace gfp
