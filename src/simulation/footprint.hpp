#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/core/convex_hull.hpp"

namespace gfp {

/// Convex polygon, counter-clockwise, without collinear corners.
using Polygon = std::vector<Eigen::Vector2d>;

/// Largest gap along a direction perpendicular to an edge of either: positive where the polygons are apart (a lower bound of
/// their distance), negative where they overlap.
double separation(const Polygon& a, const Polygon& b);

/// Point of the polygon (with its inside) nearest to `point`.
Eigen::Vector2d nearest_point(const Polygon& polygon, const Eigen::Vector2d& point);

}  // namespace gfp
