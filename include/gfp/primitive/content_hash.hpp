#pragma once

#include <cstdint>

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// First 8 bytes of a SHA-256 over triangles, filled triangles, types and parts, in this order (little-endian).
std::uint64_t topology_hash(const Topology& topology);

/// First 8 bytes of a SHA-256 over all of the primitive but `content_hash` itself, in the order of its members: the same
/// shape has the same name on every machine, whatever file format carried it.
std::uint64_t content_hash(const Primitive& primitive);

}  // namespace gfp
