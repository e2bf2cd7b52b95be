#pragma once

#include <cstdint>
#include <filesystem>

#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"

namespace gfp {

/// Reads a JPEG file as 8-bit grey. Errors: kNotFound, kIo, kCorruptData (not a JPEG, or cut off), kTooLarge (a side above kMaxImageSide).
Result<Image<std::uint8_t>> read_jpeg_grey(const std::filesystem::path& path);

}  // namespace gfp
