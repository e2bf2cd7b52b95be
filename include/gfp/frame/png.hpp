#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"

namespace gfp {

/// What the first bytes of a PNG file promise.
struct PngHeader {
  int width = 0, height = 0;
  int bit_depth = 0;
  bool grey = false;  ///< One channel, no palette, no alpha.
};

/// Reads the header alone. Errors: kNotFound, kIo, kCorruptData (not a PNG), kTooLarge (a side above kMaxImageSide).
Result<PngHeader> read_png_header(const std::filesystem::path& path);

/// 16-bit grey, as depth images are stored. Errors: as read_png_header(), and kUnsupported for any other pixel type.
Result<Image<std::uint16_t>> read_png_depth(const std::filesystem::path& path);
/// 8-bit grey (masks, labels); fewer bits are kept as stored. Errors: as read_png_depth().
Result<Image<std::uint8_t>> read_png_grey(const std::filesystem::path& path);
/// Any PNG as RGB: palettes and grey are expanded, alpha is dropped, 16 bits are cut to 8. Errors: as read_png_header().
Result<Image<Rgb8>> read_png_color(const std::filesystem::path& path);

/// The same from bytes; `name` is what errors name.
Result<Image<std::uint16_t>> decode_png_depth(std::string_view bytes, const std::string& name);

/// Errors: kInvalidArgument (empty image, or a side above kMaxImageSide), kIo.
Result<void> write_png(const std::filesystem::path& path, const Image<Rgb8>& image);
Result<void> write_png(const std::filesystem::path& path, const Image<std::uint16_t>& image);
Result<void> write_png(const std::filesystem::path& path, const Image<std::uint8_t>& image);

}  // namespace gfp
