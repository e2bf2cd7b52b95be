#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// Which triangles cross which, by index; those that count_self_intersections counts, in a fixed order.
std::vector<std::array<std::int32_t, 2>> find_self_intersections(const TriangleMesh& mesh);

struct ApproachOptions {
  int local_rounds = 8;             ///< In which only what crosses is held back, with its surroundings.
  std::vector<double> then{0.8, 0.64, 0.51, 0.41, 0.33, 0.26, 0.21, 0.17, 0.13, 0.0};  ///< Shares that all of it keeps of what is left, one after the other.
  double least_turn_cosine = -1.0;  ///< Between a triangle's normals before and after: what turns more folds, and is held back as what crosses is.
};

/// How far a surface went.
struct Approach {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<double> share;  ///< Of its way that each vertex went, in [0, 1].
  bool sound = false;         ///< It neither crosses itself nor folds: false only if the start does.
};

/// As far from `start` towards `wanted` as a surface can go without crossing itself: where triangles cross, their surroundings stay behind,
/// farther each round, and at last the whole. Points of both by vertex. Always ends, at worst at the start.
Approach approach_without_crossing(const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& wanted, const std::vector<Triangle>& triangles,
                                   const ApproachOptions& options = {});

}  // namespace gfp
