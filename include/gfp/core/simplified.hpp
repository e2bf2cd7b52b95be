#pragma once

#include "gfp/core/error.hpp"
#include "gfp/core/mesh.hpp"

namespace gfp {

/// About `vertices` of a closed manifold mesh, by quadric error (Garland and Heckbert 1997), with no edge much longer than an even mesh has;
/// closed, of the same genus, and free of self-intersections if the mesh is: what would cross is left finer.
/// Errors: kDegenerateGeometry where it still crosses itself after a few rounds of that.
Result<TriangleMesh> simplified(const TriangleMesh& mesh, int vertices);

}  // namespace gfp
