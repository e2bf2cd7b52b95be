#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// How far each vertex should move along its normal to meet the data, and how much data says so.
struct SurfaceTargets {
  std::vector<double> distance_m;  ///< Along the outward normal; 0 where there is no data.
  std::vector<double> weight;      ///< In [0, 1]; 0 where there is no data.
  std::vector<double> readings;    ///< Effective number of readings behind the target.
};

/// Compares a rendered surface with the readings pixel by pixel and hands every difference to the three vertices of the triangle
/// that was hit, by barycentric weight: like is compared with like, so curvature brings no bias, and what is hidden gets nothing.
/// The view's field has its say as well.
/// @param vertices_support  posed surface, metres, support frame of the view.
/// @param gate_m  differences beyond this along the normal are another surface.
SurfaceTargets surface_targets(const ObjectView& view, const std::vector<Eigen::Vector3d>& vertices_support, const std::vector<Eigen::Vector3d>& normals_support,
                               const std::vector<Triangle>& triangles, double gate_m);

}  // namespace gfp
