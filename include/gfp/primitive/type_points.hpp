#pragma once

#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

struct TypePointsOptions {
  double feature_dihedral_rad = 0.61;  ///< An edge folded more than this (35 degrees) is part of a boundary.
  double corner_turn_rad = 0.70;       ///< A boundary that turns more than this (40 degrees) at a vertex has a corner there.
  double extreme_share = 0.015;        ///< Within this share of the extent from an end of the widest axis: on that boundary.
  double arc_spacing_edges = 4;        ///< Distance of controls along a boundary between corners, mean edges.
  double min_curvature = 0.35;         ///< Extremes of |mean curvature| x mean edge length below this are no features.
  double fill_radius_edges = 1.6;      ///< No vertex is farther than this from a control, mean edges along the surface.
};

struct PointTyping {
  std::vector<PointType> types;  ///< Per vertex.
  int features = 0;              ///< Sharp corners and curvature extremes.
};

/// Automatic typing of a closed mesh's vertices (P8). A vertex is a control if it is
///   a. a corner: end, branch or turn of the boundaries made of sharply folded edges;
///   b. on the object's boundary along its widest axis;
///   c. at equal arc length along a boundary between corners (from the lowest index on where there is none);
///   d. an extreme of mean curvature among its neighbours' neighbours, or of the object along an axis;
///   e. (ours) chosen by farthest-point sampling along the surface until none is farther than the fill radius.
/// Deterministic. Cost: about 5 ms for 700 vertices.
PointTyping type_points(const TriangleMesh& mesh, const TypePointsOptions& options = {});

/// The automatic layer overridden by the manual one (P7): `manual` is empty or one a vertex.
std::vector<PointType> with_manual_types(std::vector<PointType> automatic, const std::vector<std::optional<PointType>>& manual);

}  // namespace gfp
