#include "replay/lzf.hpp"

#include <fmt/format.h>
#include <liblzf/lzf.h>

namespace gfp {

Result<std::string> decompress_lzf(std::string_view compressed, std::size_t size, std::string_view name) {
  if (size > kMaxLzfBytes)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: uncompressed size = {} bytes, expected at most {}", name, size, kMaxLzfBytes));
  constexpr std::size_t kBestRatio = 88;  // the longest back reference: 3 bytes that stand for 264
  if (size > kBestRatio * compressed.size())
    return failure(ErrorCode::kCorruptData, fmt::format("{}: uncompressed size = {} bytes, expected at most {} from {} compressed bytes",
                                                        name, size, kBestRatio * compressed.size(), compressed.size()));
  std::string bytes(size, '\0');
  const unsigned decoded = lzf_decompress(compressed.data(), static_cast<unsigned>(compressed.size()), bytes.data(),
                                          static_cast<unsigned>(bytes.size()));
  if (decoded != size)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: LZF data give {} bytes, expected {}", name, decoded, size));
  return bytes;
}

}  // namespace gfp
