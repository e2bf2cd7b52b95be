#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/frame/stereo_pair.hpp"

namespace gfp {

/// One transfer of a camera: rows of `width` pixels of `bytes_per_pixel`, without padding.
struct RawPicture {
  int width = 0, height = 0;
  int bytes_per_pixel = 1;
  std::span<const std::uint8_t> bytes;
};

/// Pixels of a byte an eye: of two eyes, or of three from one side to the other, of which `eyes` are taken ("outer", "left_centre", "centre_right").
/// `first_byte`: "right" or "left". Errors: kCorruptFrame (not 2 or 3 bytes a pixel, sides outside [2, kMaxImageSide], fewer bytes than pixels).
Result<StereoPair> decode_interleaved(const RawPicture& raw, const std::string& first_byte, const std::string& eyes = "outer");

/// 8-bit pixels: the left picture above the right one. Errors: as decode_interleaved(), and an odd number of rows.
Result<StereoPair> decode_stacked(const RawPicture& raw);

/// One eye of two cameras, of 8 bits or the upper 8 of 16 (little-endian). Errors: as decode_interleaved().
Result<Image<std::uint8_t>> decode_single(const RawPicture& raw);

/// A Bayer mosaic's brightness, (R + 2 G + B) / 4: a binomial filter of 3 x 3, which is that for every pattern.
Image<std::uint8_t> grey_of_bayer(const Image<std::uint8_t>& mosaic);
/// Bilinear. `pattern`: the colours of the first two rows' first two pixels, as "rggb".
Image<Rgb8> color_of_bayer(const Image<std::uint8_t>& mosaic, const std::string& pattern);

/// Grey pictures of both eyes, and the left one's colour, in the place of two mosaics. Pattern "none": nothing happens.
void take_off_mosaic(StereoPair& pair, const std::string& pattern, bool color);

}  // namespace gfp
