#pragma once

#include <optional>
#include <string_view>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {

/// What a camera file says (DESIGN, conventions). Reading the YAML is the configuration's job.
struct CameraFile {
  CameraModel camera;                   ///< width = height = 0: those of the images.
  std::optional<double> depth_scale_m;  ///< Metres per unit of 16-bit depth; empty: the format's own default.
  Transform T_world_sensor = Transform::Identity();
};

/// Reads `fx,fy,cx,cy` in pixels. Errors: kInvalidArgument naming the text, or the member out of its bounds.
Result<CameraFile> parse_inline_camera(std::string_view text);

/// The camera for images of this size: with its own size if it has none. Errors: kInvalidArgument where the sizes differ.
Result<CameraModel> camera_for_image(CameraModel camera, int width, int height);

}  // namespace gfp
