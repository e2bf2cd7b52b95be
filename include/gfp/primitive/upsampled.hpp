#pragma once

#include "gfp/primitive/primitive.hpp"

namespace gfp {

inline constexpr int kMaxUpsampling = 2;

/// The same shape and modes with every edge halved `levels` times, each time four times the triangles (P10): the contour can follow finer
/// surfaces. Typed anew at its own spacing; a person's types stay with their vertices. Another topology and content hash; no training views are
/// lost, since the shape is the same. 0: as it is.
Primitive upsampled(const Primitive& primitive, int levels);

}  // namespace gfp
