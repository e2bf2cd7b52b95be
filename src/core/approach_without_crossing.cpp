#include <algorithm>

#include "gfp/core/self_intersections.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr int kLocalRounds = 8, kGlobalRounds = 10;
constexpr double kHeldBack = 0.5;  ///< Share of its way that a crossing vertex keeps each round.
constexpr double kSlowed = 0.8;    ///< Share of its way that everything keeps, once that was not enough.
constexpr int kSpread = 2;         ///< Rings of neighbours that are slowed down with it, so that the surface does not crease.

/// Every vertex is slowed at least half as much as its slowest neighbour.
void spread(const VertexAdjacency& neighbours, std::vector<double>& slowed) {
  for (int ring = 0; ring < kSpread; ++ring) {
    const std::vector<double> before = slowed;
    for (std::size_t i = 0; i < slowed.size(); ++i)
      for (auto k = neighbours.offsets[i]; k < neighbours.offsets[i + 1]; ++k)
        slowed[i] = std::min(slowed[i], 0.5 * (1 + before[static_cast<std::size_t>(neighbours.indices[static_cast<std::size_t>(k)])]));
  }
}

}  // namespace

Approach approach_without_crossing(const std::vector<Vector3d>& sound, const std::vector<Vector3d>& wanted, const std::vector<Triangle>& triangles) {
  TriangleMesh now{wanted, triangles};
  std::vector<double> share(sound.size(), 1.0);
  const VertexAdjacency neighbours = vertex_adjacency(now);
  for (int round = 0; round <= kLocalRounds + kGlobalRounds; ++round) {
    const auto crossings = find_self_intersections(now);
    if (crossings.empty()) break;
    if (round < kLocalRounds) {
      std::vector<double> slowed(sound.size(), 1.0);
      for (const auto& pair : crossings)
        for (const auto t : pair)
          for (const auto v : triangles[static_cast<std::size_t>(t)]) slowed[static_cast<std::size_t>(v)] = kHeldBack;
      spread(neighbours, slowed);
      for (std::size_t i = 0; i < share.size(); ++i) share[i] *= slowed[i];
    } else {
      for (double& s : share) s *= round < kLocalRounds + kGlobalRounds ? kSlowed : 0.0;
    }
    for (std::size_t i = 0; i < sound.size(); ++i) now.vertices[i] = sound[i] + share[i] * (wanted[i] - sound[i]);
  }
  return {std::move(now.vertices), std::move(share)};
}

}  // namespace gfp
