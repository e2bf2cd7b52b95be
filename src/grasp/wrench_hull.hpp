#pragma once

#include <span>

#include "gfp/grasp/wrench_space.hpp"

namespace gfp {

/// Exact quality of any wrench space: the nearest facet of the convex hull of `wrenches`.
///
/// An inner simplex grows towards the origin's nearest facet: the wrench farthest beyond that facet replaces all facets it
/// sees (beneath-beyond), until no wrench lies beyond the nearest facet. The inner polytope's ball is then the hull's own,
/// although most of the hull was never built: qhull builds all of it. (In three dimensions this is the expanding polytope
/// of van den Bergen 2001; for grasps Liu & Carpin 2015 cut qhull short in the same spirit.) A new facet's hyperplane is the
/// non-negative combination of the two that meet in its ridge, so coplanar wrenches give equal hyperplanes and no slivers.
///
/// With `volume` the growth goes on until every facet is the hull's own.
GraspQuality wrench_hull_quality(std::span<const Wrench> wrenches, bool volume);

}  // namespace gfp
