#pragma once

#include "gfp/grasp/wrench_space.hpp"

namespace gfp {

/// Exact quality of two soft contacts in closed form.
///
/// Each contact is a cone over a bipyramid (polygon of E tangential forces, two torsional poles) in its own four
/// coordinates, so W is the image of a product of two cones in R^8 under the 7 x 8 matrix
///     S = [wrench maps of both contacts; 1 0 0 0 1 0 0 0]   (six wrench rows, one row that sums the normal forces to 1)
/// whose kernel is one vector k, the internal force. A halfspace of W is a covector of R^8 that vanishes on k and is not
/// negative on both cones; Fourier-Motzkin elimination of k from the 2 x 2E facets of the cones yields them all: every pair
/// of facets that k meets with opposite sign gives one. Redundant pairs give valid halfspaces that are not nearer, so no
/// adjacency is needed and degenerate grasps need no care. epsilon is the least offset / |normal|.
///
/// The facets with a positive sign project onto W without overlap, which gives the volume as a sum over them.
GraspQuality soft_pair_quality(const WrenchContact& first, const WrenchContact& second, const WrenchScale& scale, int cone_edges);

}  // namespace gfp
