#pragma once

#include <filesystem>

#include "gfp/primitive/primitive_library.hpp"

namespace gfp {

/// The primitives that ship with the program: generated and embedded at build time, read on the first call; safe from any thread.
const PrimitiveLibrary& builtin_library();

/// The built-in primitives with those of a user's folder (*.gfp) beside them; of one class, the user's is taken.
/// Errors: kNotFound (no such folder), and what reading a file gives (wire/primitive_file.hpp).
Result<PrimitiveLibrary> library_with(const std::filesystem::path& folder);

/// Errors: kNotFound for a class (or alias) that the library does not have, naming the known ones.
Result<PrimitivePtr> find_class(const PrimitiveLibrary& library, std::string_view class_name);

}  // namespace gfp
