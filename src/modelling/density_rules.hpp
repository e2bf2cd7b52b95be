#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "modelling/point_count.hpp"

namespace gfp {

/// Unit steps in which a control looks, outwards first: ties go to the earlier (P25).
std::vector<Eigen::Vector3d> normal_directions(const Eigen::Vector3d& normal);
/// The 26 steps of a grid, of length 1, sqrt 2 and sqrt 3, the most outward first.
std::vector<Eigen::Vector3d> grid_directions(const Eigen::Vector3d& normal);

/// The paper's two rules (P25): where a control at `place` should go, looking at `place + k step_m direction`, k = 1, 2... within search_m.
///   (i)  points near `place`: the nearest position with none near; where there is no such, the nearest of those with fewest.
///   (ii) none near: the nearest position with some near; nothing where there is none, which freezes the control.
std::optional<Eigen::Vector3d> best_candidate(const Eigen::Vector3d& place, const std::vector<Eigen::Vector3d>& directions, const PointCount& count,
                                              double step_m, double search_m);

}  // namespace gfp
