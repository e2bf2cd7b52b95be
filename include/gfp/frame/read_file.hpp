#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// The bytes of a regular file, at most `max_bytes` of them: a larger file is refused before anything is allocated.
/// Errors: kNotFound, kIo (a folder, no permission, a failed read), kTooLarge.
Result<std::string> read_file(const std::filesystem::path& path, std::uintmax_t max_bytes);

}  // namespace gfp
