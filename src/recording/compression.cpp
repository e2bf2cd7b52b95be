#include "recording/compression.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

namespace gfp {
namespace {

// The best that the formats can do: a zstd block of 128 KiB in 4 bytes, an lz4 sequence of 255 bytes a byte.
constexpr std::size_t kZstdMaxRatio = 32'768, kLz4MaxRatio = 255;

Result<void> check_promise(std::string_view compression, std::size_t compressed, std::size_t size, std::size_t max_ratio) {
  if (size / max_ratio > compressed)
    return failure(ErrorCode::kTooLarge, fmt::format("{} bytes of {} promise {}, at most {} times as many are possible", compressed, compression, size, max_ratio));
  return {};
}

Result<void> unzstd(std::string_view bytes, std::size_t size, std::string& out) {
  if (auto possible = check_promise("zstd", bytes.size(), size, kZstdMaxRatio); !possible) return possible;
  out.resize(size);
  const std::size_t got = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0U) return failure(ErrorCode::kCorruptData, fmt::format("damaged zstd: {}", ZSTD_getErrorName(got)));
  if (got != size) return failure(ErrorCode::kCorruptData, fmt::format("zstd holds {} bytes, expected {}", got, size));
  return {};
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

Result<void> unlz4(std::string_view bytes, std::size_t size, std::string& out) {
  if (auto possible = check_promise("lz4", bytes.size(), size, kLz4MaxRatio); !possible) return possible;
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0U) return failure(ErrorCode::kIo, "lz4: out of memory");
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(raw);
  out.resize(size);
  std::size_t done = 0;
  while (!bytes.empty()) {
    std::size_t room = size - done, taken = bytes.size();
    const std::size_t hint = LZ4F_decompress(context.get(), out.data() + done, &room, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0U) return failure(ErrorCode::kCorruptData, fmt::format("damaged lz4: {}", LZ4F_getErrorName(hint)));
    bytes.remove_prefix(taken);
    done += room;
    if (hint == 0 || (room == 0 && taken == 0)) break;
  }
  if (done != size || !bytes.empty()) return failure(ErrorCode::kCorruptData, fmt::format("lz4 holds {} bytes or more, expected {}", done, size));
  return {};
}

}  // namespace

struct ZstdCompressor::Context {
  ZSTD_CCtx* zstd = ZSTD_createCCtx();
  ~Context() { ZSTD_freeCCtx(zstd); }
};

ZstdCompressor::ZstdCompressor(int level) : context_(std::make_unique<Context>()) {
  if (context_->zstd != nullptr) ZSTD_CCtx_setParameter(context_->zstd, ZSTD_c_compressionLevel, level);
}
ZstdCompressor::~ZstdCompressor() = default;
ZstdCompressor::ZstdCompressor(ZstdCompressor&&) noexcept = default;

Result<void> ZstdCompressor::append(std::string_view bytes, std::string& out) {
  if (context_->zstd == nullptr) return failure(ErrorCode::kIo, "zstd: out of memory");
  const std::size_t before = out.size();
  out.resize(before + ZSTD_compressBound(bytes.size()));
  const std::size_t got = ZSTD_compress2(context_->zstd, out.data() + before, out.size() - before, bytes.data(), bytes.size());
  out.resize(before + (ZSTD_isError(got) != 0U ? 0 : got));
  if (ZSTD_isError(got) != 0U) return failure(ErrorCode::kIo, fmt::format("zstd: {}", ZSTD_getErrorName(got)));
  return {};
}

Result<std::size_t> zstd_content_size(std::string_view bytes, std::size_t max) {
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) return failure(ErrorCode::kCorruptData, "no zstd frame that says its content's size");
  if (size > max) return failure(ErrorCode::kTooLarge, fmt::format("zstd promises {} bytes, at most {} are read", size, max));
  return static_cast<std::size_t>(size);
}

Result<void> decompress(std::string_view compression, std::string_view bytes, std::size_t size, std::string& out) {
  if (compression == "zstd") return unzstd(bytes, size, out);
  if (compression == "lz4") return unlz4(bytes, size, out);
  if (!compression.empty()) return failure(ErrorCode::kUnsupported, fmt::format("compression `{}`, expected zstd, lz4 or none", compression.substr(0, 32)));
  if (bytes.size() != size) return failure(ErrorCode::kCorruptData, fmt::format("a chunk of {} bytes without compression holds {}", size, bytes.size()));
  out.assign(bytes);
  return {};
}

}  // namespace gfp
