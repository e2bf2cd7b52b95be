#pragma once

#include "gfp/core/error.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp::wire {

/// What a primitive promises to those who use it, checked for one that came from outside: see decode_primitive.
Result<void> check_primitive(const Primitive& primitive);

}  // namespace gfp::wire
