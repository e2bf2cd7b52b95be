#pragma once

#include "gfp/primitive/primitive_library.hpp"

namespace gfp {

/// The primitives that ship with the program. Made on the first call; safe from any thread.
const PrimitiveLibrary& builtin_library();

/// Errors: kNotFound for a class (or alias) that the library does not have, naming the known ones.
Result<PrimitivePtr> find_class(const PrimitiveLibrary& library, std::string_view class_name);

}  // namespace gfp
