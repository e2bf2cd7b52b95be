#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"
#include "replay/pcd_header.hpp"

namespace gfp {

/// An organised cloud as it stands in the file: one point per pixel, row-major, the file's own axes and units.
struct PcdCloud {
  int width = 0, height = 0;
  std::array<std::vector<float>, 3> xyz;  ///< Columns; NaN (or 0, 0, 0) where there is no reading.
  Image<Rgb8> color;                      ///< Empty without a field rgb or rgba.
  Image<std::uint32_t> labels;            ///< Empty without a field label.
  std::string viewpoint;                  ///< As written; not applied.
};

/// Decodes an organised PCD of any data kind. Other fields are skipped. Memory: at most kMaxPcdBytes, in proportion to the file.
/// Errors: kCorruptData, kTooLarge, kUnsupported (unorganised: height 1; no x, y or z). `name` begins the messages.
Result<PcdCloud> decode_pcd(std::string_view bytes, std::string_view name);

/// decode_pcd() of a file. Errors: also kNotFound, kIo.
Result<PcdCloud> read_pcd(const std::filesystem::path& path);

/// The `label` field of an organised cloud, one per pixel: ground truth for tests and evaluation.
/// Errors: as read_pcd(), and kUnsupported where there is no such field.
Result<Image<std::uint32_t>> read_pcd_labels(const std::filesystem::path& path);

inline constexpr std::uintmax_t kMaxPcdBytes = std::uintmax_t{512} << 20U;

}  // namespace gfp
