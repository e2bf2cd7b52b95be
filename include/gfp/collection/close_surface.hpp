#pragma once

#include "gfp/core/error.hpp"
#include "gfp/core/mesh.hpp"

namespace gfp {

struct CloseSurfaceOptions {
  int voxels = 80;      ///< Along the longest side: what is thinner than about one of them may be lost.
  int vertices = 2500;  ///< About so many are kept.
  bool as_is = true;    ///< A mesh that is one sound surface already is only simplified; false: its tunnels are sealed with the rest.
};

/// Any triangles as one closed, oriented, manifold surface that crosses itself nowhere: cracks up to two voxels wide are sealed, inner shells and
/// loose parts go, sheets get a thickness (half a voxel or so). The body is voxelised and flooded from outside, its border extracted, simplified, and
/// drawn back onto the triangles. Errors: those of fill_solid; kDegenerateGeometry where nothing solid is left.
Result<TriangleMesh> close_surface(const TriangleMesh& soup, const CloseSurfaceOptions& options = {});

}  // namespace gfp
