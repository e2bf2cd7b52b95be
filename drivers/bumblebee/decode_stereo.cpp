#include "bumblebee/decode_stereo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gfp {
namespace {

Result<void> check(const RawPicture& raw, int bytes_per_pixel) {
  if (raw.bytes_per_pixel != bytes_per_pixel) return failure(ErrorCode::kCorruptFrame, fmt::format("pixels have {} bytes, expected {}", raw.bytes_per_pixel, bytes_per_pixel));
  if (raw.width < 2 || raw.height < 2 || raw.width > kMaxImageSide || raw.height > 2 * kMaxImageSide)
    return failure(ErrorCode::kCorruptFrame, fmt::format("picture is {} x {}, expected sides in [2, {}]", raw.width, raw.height, kMaxImageSide));
  const std::size_t needed = static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.height) * static_cast<std::size_t>(bytes_per_pixel);
  if (raw.bytes.size() < needed) return failure(ErrorCode::kCorruptFrame, fmt::format("picture has {} bytes, expected {}", raw.bytes.size(), needed));
  return {};
}

/// Calls visit(index of the pixel, its neighbours' indices in a 3 x 3 window, row by row; the border repeats inwards so that colours stay in phase).
template <class Visit>
void for_each_window(const Image<std::uint8_t>& image, Visit&& visit) {
  const auto inwards = [](int i, int size) { return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i; };
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      std::array<std::size_t, 9> window;
      for (int k = 0; k < 9; ++k) window[static_cast<std::size_t>(k)] = image.index(inwards(u + k % 3 - 1, image.width), inwards(v + k / 3 - 1, image.height));
      visit(u, v, window);
    }
}

}  // namespace

Result<StereoPair> decode_interleaved(const RawPicture& raw, const std::string& first_byte, const std::string& eyes) {
  if (auto usable = check(raw, raw.bytes_per_pixel == 3 ? 3 : 2); !usable) return tl::unexpected<Error>(usable.error());
  const auto bytes = static_cast<std::size_t>(raw.bytes_per_pixel), last = bytes - 1;
  // Counted from the left; a camera that sends the right eye first counts the other way.
  std::size_t left = bytes == 3 && eyes == "centre_right" ? 1 : 0, right = bytes == 3 && eyes == "left_centre" ? 1 : last;
  if (first_byte == "right") left = last - left, right = last - right;
  StereoPair pair{Image<std::uint8_t>(raw.width, raw.height), Image<std::uint8_t>(raw.width, raw.height), {}};
  for (std::size_t i = 0; i < pair.left.pixels.size(); ++i) pair.left.pixels[i] = raw.bytes[bytes * i + left], pair.right.pixels[i] = raw.bytes[bytes * i + right];
  return pair;
}

Result<StereoPair> decode_stacked(const RawPicture& raw) {
  if (auto usable = check(raw, 1); !usable) return tl::unexpected<Error>(usable.error());
  if (raw.height % 2 != 0 || raw.height < 4) return failure(ErrorCode::kCorruptFrame, fmt::format("two pictures in {} rows, expected an even number above 3", raw.height));
  StereoPair pair{Image<std::uint8_t>(raw.width, raw.height / 2), Image<std::uint8_t>(raw.width, raw.height / 2), {}};
  const auto size = static_cast<std::ptrdiff_t>(pair.left.pixels.size());
  std::copy_n(raw.bytes.begin(), size, pair.left.pixels.begin());
  std::copy_n(raw.bytes.begin() + size, size, pair.right.pixels.begin());
  return pair;
}

Result<Image<std::uint8_t>> decode_single(const RawPicture& raw) {
  if (auto usable = check(raw, raw.bytes_per_pixel == 2 ? 2 : 1); !usable) return tl::unexpected<Error>(usable.error());
  Image<std::uint8_t> image(raw.width, raw.height);
  const std::size_t step = static_cast<std::size_t>(raw.bytes_per_pixel);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = raw.bytes[step * i + step - 1];
  return image;
}

Image<std::uint8_t> grey_of_bayer(const Image<std::uint8_t>& mosaic) {
  static constexpr std::array<int, 9> kBinomial{1, 2, 1, 2, 4, 2, 1, 2, 1};
  Image<std::uint8_t> grey(mosaic.width, mosaic.height);
  for_each_window(mosaic, [&](int u, int v, const std::array<std::size_t, 9>& window) {
    int sum = 8;
    for (std::size_t k = 0; k < 9; ++k) sum += kBinomial[k] * mosaic.pixels[window[k]];
    grey.at(u, v) = static_cast<std::uint8_t>(sum / 16);
  });
  return grey;
}

Image<Rgb8> color_of_bayer(const Image<std::uint8_t>& mosaic, const std::string& pattern) {
  // The channel of every place in a 2 x 2 cell.
  std::array<std::size_t, 4> channel{};
  for (std::size_t i = 0; i < 4 && i < pattern.size(); ++i) channel[i] = pattern[i] == 'r' ? 0 : pattern[i] == 'g' ? 1 : 2;
  Image<Rgb8> color(mosaic.width, mosaic.height);
  for_each_window(mosaic, [&](int u, int v, const std::array<std::size_t, 9>& window) {
    std::array<int, 3> sum{}, count{};
    for (int k = 0; k < 9; ++k) {
      const std::size_t c = channel[static_cast<std::size_t>(((v + k / 3 + 1) % 2) * 2 + (u + k % 3 + 1) % 2)];
      const bool own = k == 4 || c != channel[static_cast<std::size_t>((v % 2) * 2 + u % 2)];  // of its own colour the pixel has the reading itself
      if (!own) continue;
      sum[c] += mosaic.pixels[window[static_cast<std::size_t>(k)]], ++count[c];
    }
    const auto part = [&](std::size_t c) { return static_cast<std::uint8_t>((sum[c] + count[c] / 2) / std::max(1, count[c])); };
    color.at(u, v) = {part(0), part(1), part(2)};
  });
  return color;
}

void take_off_mosaic(StereoPair& pair, const std::string& pattern, bool color) {
  if (pattern == "none") return;
  if (color) pair.color = color_of_bayer(pair.left, pattern);
  pair.left = grey_of_bayer(pair.left);
  pair.right = grey_of_bayer(pair.right);
}

}  // namespace gfp
