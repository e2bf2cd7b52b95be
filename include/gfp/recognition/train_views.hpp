#pragma once

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Renders a primitive as a depth camera would see it and describes each view (ALGORITHM 4): instances drawn from its own size and
/// shape priors, in every stable pose, from the upper hemisphere, with sensor noise. Deterministic.
/// Cost: about 50 ms; the built-in primitives carry theirs.
TrainingViews train_views(const Primitive& primitive);

}  // namespace gfp
