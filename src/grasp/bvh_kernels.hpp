#pragma once

#include "grasp/triangle_bvh.hpp"

namespace gfp {

// The inner loops of TriangleBvh over four lanes, compiled for AVX2 and for the baseline; both give the same bits.

/// Where a ray enters each box, at least 0; 1e300 where it misses. `inverse`: 1 / direction, component by component.
void ray_to_boxes(const TriangleBvh::Node& node, const double* origin, const double* inverse, double* entry);

/// Moller & Trumbore 1997, both sides: distance along the ray (negative or NaN where there is no crossing) and the
/// determinant, positive where the ray enters.
void ray_to_triangles(const TriangleBvh::Leaf& leaf, const double* origin, const double* direction, double* distance, double* determinant);

/// Squared distance in box coordinates between each lane's bounds and the box: a lower bound for what is inside.
/// `rotation`: row-major T_box_world rotation.
void box_to_boxes(const TriangleBvh::Node& node, const double* rotation, const double* translation, const double* half, double* squared);

/// The corners in box coordinates, [corner][axis][lane].
void corners_in_box(const TriangleBvh::Leaf& leaf, const double* rotation, const double* translation, double (*corners)[3][4]);

}  // namespace gfp
