#pragma once

#include <cstddef>
#include <span>

namespace gfp {

/// A v1.PrimitiveSet with the primitives of all families, generated when the library was built.
std::span<const std::byte> embedded_primitives();

}  // namespace gfp
