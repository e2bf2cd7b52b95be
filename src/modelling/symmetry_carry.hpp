#pragma once

#include "gfp/primitive/primitive.hpp"
#include "modelling/surface_targets.hpp"

namespace gfp {

/// Gives vertices without data the displacement of their symmetric counterparts (ring mates of a body of revolution, mirror images),
/// as weak data: `weight` times the counterpart's own.
void carry_by_symmetry(const Primitive& primitive, double weight, SurfaceTargets& targets);

}  // namespace gfp
