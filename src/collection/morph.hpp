#pragma once

#include "gfp/core/mesh.hpp"
#include "gfp/evaluation/triangle_tree.hpp"

namespace gfp {

/// The template's vertices moved onto another surface of its kind, so that the same index means the same place: scaled to its extents, then
/// drawn along the normals onto what faces the same way, ever less stiffly (non-rigid ICP). Never crosses itself if the template
/// does not: where a softer stretch would, the stiffer one before stays.
std::vector<Eigen::Vector3d> morph(const TriangleMesh& shape, const TriangleMesh& onto, const TriangleTree& onto_tree);

/// Mean distance between two surfaces, both ways, over `samples` points each.
double surface_distance_m(const TriangleMesh& a, const TriangleTree& a_tree, const TriangleMesh& b, const TriangleTree& b_tree, int samples);

}  // namespace gfp
