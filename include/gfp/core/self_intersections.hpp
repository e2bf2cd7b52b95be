#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// Which triangles cross which, by index; those that count_self_intersections counts, in a fixed order.
std::vector<std::array<std::int32_t, 2>> find_self_intersections(const TriangleMesh& mesh);

/// How far a surface went.
struct Approach {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<double> share;  ///< Of its way that each vertex went, in [0, 1].
};

/// As far from `sound` towards `wanted` as a surface can go without crossing itself: where triangles cross, their surroundings stay behind,
/// farther each round, and at last the whole. Points of both by vertex; `sound` crosses itself nowhere. Always ends, at worst with `sound`.
Approach approach_without_crossing(const std::vector<Eigen::Vector3d>& sound, const std::vector<Eigen::Vector3d>& wanted, const std::vector<Triangle>& triangles);

}  // namespace gfp
