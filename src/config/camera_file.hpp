#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"
#include "gfp/frame/camera_file.hpp"

namespace gfp::config {

/// Reads a camera file (DESIGN, conventions):
///
///     width: 640
///     height: 480
///     fx: 525.0
///     fy: 525.0
///     cx: 319.5
///     cy: 239.5
///     depth_scale: 0.001                   # metres per unit; absent: the format's own default
///     distortion: {model: plumb_bob, coefficients: [0.1, -0.2, 0, 0, 0]}   # none, plumb_bob or rational_polynomial
///     T_world_sensor: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
///
/// Errors: kNotFound, kIo, kTooLarge, kCorruptData, kInvalidArgument (a missing side or focal length among them).
Result<CameraFile> load_camera_file(const std::filesystem::path& file);

/// The same from text; `source` is what errors name.
Result<CameraFile> parse_camera_file(std::string_view text, const std::string& source);

/// What users give as a camera: a file, or `fx,fy,cx,cy`.
Result<CameraFile> load_camera(const std::string& file_or_inline);

}  // namespace gfp::config
