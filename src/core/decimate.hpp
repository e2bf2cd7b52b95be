#pragma once

#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// Collapses edges of a closed manifold mesh, least quadric error first (Garland and Heckbert 1997), until `vertices` are left or no collapse
/// is allowed: one that would change the topology, turn a triangle by more than 60 degrees, make it a needle, or leave an edge longer than
/// `longest_edge_m`. A vertex never moves: it stays or goes; those that are `locked` (a flag each, or none) stay. Deterministic. Cost: about 8 us a collapse.
TriangleMesh decimated(const TriangleMesh& mesh, int vertices, double longest_edge_m, std::vector<std::uint8_t> locked = {});

}  // namespace gfp
