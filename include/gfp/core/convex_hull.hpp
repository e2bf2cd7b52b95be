#pragma once

#include <Eigen/Core>
#include <vector>

namespace gfp {

/// Corners of the smallest convex polygon around `points`, counter-clockwise, no three on a line (Andrew, IPL 1979).
/// Fewer than three distinct points come back as they are.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

}  // namespace gfp
