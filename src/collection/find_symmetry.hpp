#pragma once

#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Which turns about z, mirror planes and flips leave a closed shape where it is, up to `tolerance` of its longest side (mean distance of
/// its surface from the moved one's). Planes are looked for at x = 0 and y = 0 only: see yaw_of_mirror_plane().
Symmetry find_symmetry(const TriangleMesh& mesh, double tolerance = 0.012);

/// The turn about z that brings the shape's best mirror plane to y = 0, and what reaches out farther (a handle) to +x.
double yaw_of_mirror_plane(const TriangleMesh& mesh);

}  // namespace gfp
