#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/image.hpp"

namespace gfp {

/// PCL's LZF image files: "PCLZF", width, height (uint32), type (16 bytes, padded by spaces), compressed and uncompressed
/// size (uint32), LZF data. Errors of both: kNotFound, kIo, kCorruptData, kTooLarge, kUnsupported (another type).
Result<Image<std::uint16_t>> read_pclzf_depth(const std::filesystem::path& path);  ///< Type depth16.
Result<Image<Rgb8>> read_pclzf_color(const std::filesystem::path& path);           ///< Type rgb24: planes red, green, blue.

/// The .xml that stands beside: the intrinsics of the depth camera (width and height 0: those of the images).
struct PclzfCalibration {
  CameraModel camera;
  double depth_scale_m = 0.001;
};

/// Finds <depth> and its five numbers; nothing else of XML is understood. Errors: kNotFound, kIo, kTooLarge, kCorruptData.
Result<PclzfCalibration> read_pclzf_calibration(const std::filesystem::path& path);
Result<PclzfCalibration> parse_pclzf_calibration(std::string_view xml, std::string_view name);

}  // namespace gfp
