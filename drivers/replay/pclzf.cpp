#include "replay/pclzf.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <optional>
#include <string>

#include "gfp/frame/read_file.hpp"
#include "replay/lzf.hpp"

namespace gfp {
namespace {

constexpr std::string_view kMagic = "PCLZF";
constexpr std::size_t kHeaderBytes = 5 + 4 + 4 + 16 + 4 + 4;

struct Payload {
  int width = 0, height = 0;
  std::string bytes;
};

/// Reads and decompresses an image of `type` with `pixel_bytes` a pixel.
Result<Payload> read_payload(const std::filesystem::path& path, std::string_view type, std::size_t pixel_bytes) {
  const Result<std::string> file = read_file(path, kMaxLzfBytes);
  if (!file) return tl::unexpected<Error>(file.error());
  const std::string name = path.string();
  const std::string_view bytes = *file;
  if (bytes.size() < kHeaderBytes || !bytes.starts_with(kMagic))
    return failure(ErrorCode::kCorruptData, fmt::format("{}: not a PCLZF file ({} bytes)", name, bytes.size()));
  std::uint32_t size[2] = {}, lengths[2] = {};  // width, height; compressed, uncompressed
  std::memcpy(size, bytes.data() + 5, 8);
  std::memcpy(lengths, bytes.data() + 29, 8);
  std::string_view found = bytes.substr(13, 16);
  found = found.substr(0, found.find_first_of(std::string_view(" \0", 2)));
  if (found != type) return failure(ErrorCode::kUnsupported, fmt::format("{}: type = '{}', expected {}", name, found, type));
  if (size[0] > kMaxImageSide || size[1] > kMaxImageSide)
    return failure(ErrorCode::kTooLarge, fmt::format("{}: size = {} x {}, expected at most {} a side", name, size[0], size[1], kMaxImageSide));
  const std::size_t needed = std::size_t{size[0]} * size[1] * pixel_bytes;
  if (needed == 0) return failure(ErrorCode::kCorruptData, fmt::format("{}: size = {} x {}, expected at least 1 x 1", name, size[0], size[1]));
  if (lengths[1] != needed)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: uncompressed size = {} bytes, expected {} for {} x {} pixels", name, lengths[1],
                                                        needed, size[0], size[1]));
  if (lengths[0] > bytes.size() - kHeaderBytes)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: compressed data = {} bytes, expected {}", name, bytes.size() - kHeaderBytes, lengths[0]));
  Result<std::string> pixels = decompress_lzf(bytes.substr(kHeaderBytes, lengths[0]), needed, name);
  if (!pixels) return tl::unexpected<Error>(pixels.error());
  return Payload{static_cast<int>(size[0]), static_cast<int>(size[1]), std::move(*pixels)};
}

std::optional<double> number_in(std::string_view xml, std::string_view tag) {
  const std::string open = fmt::format("<{}>", tag);
  std::size_t at = xml.find(open);
  if (at == std::string_view::npos) return std::nullopt;
  at = xml.find_first_not_of(" \t\r\n", at + open.size());
  if (at == std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(xml.data() + at, xml.data() + xml.size(), value);
  if (error != std::errc{} || end == xml.data() + xml.size() || (*end != '<' && *end != ' ')) return std::nullopt;
  return value;
}

}  // namespace

Result<Image<std::uint16_t>> read_pclzf_depth(const std::filesystem::path& path) {
  const Result<Payload> payload = read_payload(path, "depth16", 2);
  if (!payload) return tl::unexpected<Error>(payload.error());
  Image<std::uint16_t> depth(payload->width, payload->height);
  std::memcpy(depth.pixels.data(), payload->bytes.data(), payload->bytes.size());
  return depth;
}

Result<Image<Rgb8>> read_pclzf_color(const std::filesystem::path& path) {
  const Result<Payload> payload = read_payload(path, "rgb24", 3);
  if (!payload) return tl::unexpected<Error>(payload.error());
  Image<Rgb8> color(payload->width, payload->height);
  const std::size_t n = color.pixels.size();
  const auto plane = [&](std::size_t k, std::size_t i) { return static_cast<std::uint8_t>(payload->bytes[k * n + i]); };
  for (std::size_t i = 0; i < n; ++i) color.pixels[i] = {plane(0, i), plane(1, i), plane(2, i)};
  return color;
}

Result<PclzfCalibration> read_pclzf_calibration(const std::filesystem::path& path) {
  const Result<std::string> xml = read_file(path, 1U << 16U);
  if (!xml) return tl::unexpected<Error>(xml.error());
  return parse_pclzf_calibration(*xml, path.string());
}

Result<PclzfCalibration> parse_pclzf_calibration(std::string_view xml, std::string_view name) {
  const std::size_t begin = xml.find("<depth>"), end = xml.find("</depth>");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
    return failure(ErrorCode::kCorruptData, fmt::format("{}: no <depth> section", name));
  const std::string_view depth = xml.substr(begin, end - begin);
  PclzfCalibration calibration;
  const std::pair<const char*, double*> wanted[] = {{"focal_length_x", &calibration.camera.fx},
                                                    {"focal_length_y", &calibration.camera.fy},
                                                    {"principal_point_x", &calibration.camera.cx},
                                                    {"principal_point_y", &calibration.camera.cy},
                                                    {"z_multiplication_factor", &calibration.depth_scale_m}};
  for (const auto& [tag, out] : wanted) {
    const std::optional<double> value = number_in(depth, tag);
    if (!value) return failure(ErrorCode::kCorruptData, fmt::format("{}: <depth> has no number <{}>", name, tag));
    *out = *value;
  }
  return calibration;
}

}  // namespace gfp
