#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp {

/// Compresses with zstd, again and again without new memory. One thread at a time.
class ZstdCompressor {
 public:
  explicit ZstdCompressor(int level);
  ~ZstdCompressor();
  ZstdCompressor(ZstdCompressor&&) noexcept;

  /// Appends the compressed bytes (one frame with its content's size) to `out`. Errors: kIo (out of memory).
  Result<void> append(std::string_view bytes, std::string& out);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// The size that a zstd frame says its content has. Errors: kCorruptData (no frame, or it does not say), kTooLarge (above `max`).
Result<std::size_t> zstd_content_size(std::string_view bytes, std::size_t max);

/// What `bytes` hold, which must be exactly `size` bytes. `compression` as MCAP names it: `zstd`, `lz4` (frames) or empty.
/// Errors: kUnsupported (another compression), kTooLarge (more than the compression could ever hold: refused before anything is
/// allocated), kCorruptData.
Result<void> decompress(std::string_view compression, std::string_view bytes, std::size_t size, std::string& out);

}  // namespace gfp
