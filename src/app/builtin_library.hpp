#pragma once

#include <filesystem>
#include <string>

#include "gfp/primitive/primitive_library.hpp"
#include "gfp/primitive/upsampled.hpp"

namespace gfp {

/// The primitives that ship with the program: generated and embedded at build time, read on the first call; safe from any thread.
const PrimitiveLibrary& builtin_library();

/// The built-in primitives with those of a user's folder (*.gfp) beside them: a class that the folder has replaces the built-in ones of that
/// class and name. An empty path: the built-in ones alone. All of them upsampled() so many times.
/// Errors: kNotFound (no such folder, or no primitive in it), kCorruptData (two files with primitives of one name), and what reading a file
/// gives (wire/primitive_file.hpp).
Result<PrimitiveLibrary> library_with(const std::filesystem::path& folder, int upsampling = 0);

/// The same for a folder that a configuration names, relative to it. Errors: as library_with(), with `primitives: ` in front.
Result<PrimitiveLibrary> library_of_configuration(const std::string& primitives, int upsampling, const std::filesystem::path& configuration);

/// Errors: kNotFound for a class (or alias) that the library does not have, naming the known ones.
Result<PrimitivePtr> find_class(const PrimitiveLibrary& library, std::string_view class_name);

}  // namespace gfp
