#pragma once

#include "gfp/core/mesh.hpp"
#include "gfp/evaluation/voxel_solid.hpp"

namespace gfp {

/// The border of a body of voxels as a smooth, closed, oriented, manifold surface, about a voxel outside the triangles that the voxels were
/// made of: occupancy blurred over three voxels, then marching tetrahedra. Sheets one voxel thick survive. The largest
/// component alone; empty for an empty body. Cost: about 30 ms and 10 MB for 80^3 voxels.
TriangleMesh extract_border(const VoxelSolid& solid);

}  // namespace gfp
