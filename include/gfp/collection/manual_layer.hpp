#pragma once

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Brings the manual types of an earlier primitive of the class to a new one: to the same vertices where the connectivity is the same,
/// else to the nearest point of the canonical shape within an edge's length. Returns how many found no place.
int carry_manual_types(const Primitive& before, Primitive& now);

}  // namespace gfp
