#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp {

/// Decompresses an LZF block that must give exactly `size` bytes. What cannot be (more than LZF's best ratio) is refused
/// before anything is allocated, so memory stays below 89 times the input. `name` begins the message.
/// Errors: kCorruptData, kTooLarge (above kMaxLzfBytes).
Result<std::string> decompress_lzf(std::string_view compressed, std::size_t size, std::string_view name);

inline constexpr std::size_t kMaxLzfBytes = std::size_t{512} << 20U;

}  // namespace gfp
