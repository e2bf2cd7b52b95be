#include <Eigen/Geometry>
#include <algorithm>

#include "gfp/core/self_intersections.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kHeldBack = 0.5;  ///< Share of its way that a crossing vertex keeps each round.
constexpr int kSpread = 2;         ///< Rings of neighbours that are slowed down with it, so that the surface does not crease.
constexpr double kSliver = 1e-3;   ///< A triangle that shrinks to this share of its height has folded.

/// Every vertex is slowed at least half as much as its slowest neighbour.
void spread(const VertexAdjacency& neighbours, std::vector<double>& slowed) {
  for (int ring = 0; ring < kSpread; ++ring) {
    const std::vector<double> before = slowed;
    for (std::size_t i = 0; i < slowed.size(); ++i)
      for (auto k = neighbours.offsets[i]; k < neighbours.offsets[i + 1]; ++k)
        slowed[i] = std::min(slowed[i], 0.5 * (1 + before[static_cast<std::size_t>(neighbours.indices[static_cast<std::size_t>(k)])]));
  }
}

Vector3d scaled_normal(const std::vector<Vector3d>& points, const Triangle& t) {
  const Vector3d& a = points[static_cast<std::size_t>(t[0])];
  return (points[static_cast<std::size_t>(t[1])] - a).cross(points[static_cast<std::size_t>(t[2])] - a);
}

/// The triangles that are in the way: folded against the start, or, where none is, crossing others.
std::vector<std::int32_t> offenders(const std::vector<Vector3d>& start, const TriangleMesh& now, double least_turn_cosine) {
  std::vector<std::int32_t> found;
  for (std::size_t t = 0; t < now.triangles.size() && least_turn_cosine > -1; ++t) {
    const Vector3d before = scaled_normal(start, now.triangles[t]), after = scaled_normal(now.vertices, now.triangles[t]);
    if (before.dot(after) < least_turn_cosine * before.norm() * after.norm() || after.squaredNorm() < kSliver * kSliver * before.squaredNorm()) found.push_back(static_cast<std::int32_t>(t));
  }
  if (!found.empty()) return found;
  for (const auto& pair : find_self_intersections(now)) found.insert(found.end(), pair.begin(), pair.end());
  return found;
}

}  // namespace

Approach approach_without_crossing(const std::vector<Vector3d>& start, const std::vector<Vector3d>& wanted, const std::vector<Triangle>& triangles, const ApproachOptions& options) {
  TriangleMesh now{wanted, triangles};
  Approach approach{{}, std::vector<double>(start.size(), 1.0), false};
  VertexAdjacency neighbours;
  std::vector<double> local;
  const int rounds = options.local_rounds + static_cast<int>(options.then.size());
  for (int round = 0;; ++round) {
    const auto in_the_way = offenders(start, now, options.least_turn_cosine);
    approach.sound = in_the_way.empty();
    if (approach.sound || round == rounds) break;
    if (round < options.local_rounds) {
      if (round == 0) neighbours = vertex_adjacency(now);
      std::vector<double> slowed(start.size(), 1.0);
      for (const auto t : in_the_way)
        for (const auto v : triangles[static_cast<std::size_t>(t)]) slowed[static_cast<std::size_t>(v)] = kHeldBack;
      spread(neighbours, slowed);
      for (std::size_t i = 0; i < slowed.size(); ++i) approach.share[i] *= slowed[i];
      local = approach.share;
    } else {
      const double all = options.then[static_cast<std::size_t>(round - options.local_rounds)];
      for (std::size_t i = 0; i < start.size(); ++i) approach.share[i] = all * (local.empty() ? 1.0 : local[i]);
    }
    for (std::size_t i = 0; i < start.size(); ++i) now.vertices[i] = start[i] + approach.share[i] * (wanted[i] - start[i]);
  }
  approach.vertices = std::move(now.vertices);
  return approach;
}

}  // namespace gfp
