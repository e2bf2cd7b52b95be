#include "gfp/frame/camera_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace gfp {

Result<CameraFile> parse_inline_camera(std::string_view text) {
  const auto malformed = [&] {
    return failure(ErrorCode::kInvalidArgument, fmt::format("camera = '{}', expected fx,fy,cx,cy in pixels", text.substr(0, 80)));
  };
  std::array<double, 4> values{};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return malformed();
    const auto [rest, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc{}) return malformed();
    at = rest;
  }
  if (at != end) return malformed();
  CameraFile file;
  file.camera.fx = values[0], file.camera.fy = values[1], file.camera.cx = values[2], file.camera.cy = values[3];
  CameraModel sized = file.camera;  // the side of the image is not known yet: any valid one lets the rest be checked
  sized.width = sized.height = 1;
  if (const Result<void> valid = validate(sized); !valid) return tl::unexpected<Error>(valid.error());
  return file;
}

Result<CameraModel> camera_for_image(CameraModel camera, int width, int height) {
  if (camera.width == 0 && camera.height == 0) camera.width = width, camera.height = height;
  if (camera.width != width || camera.height != height)
    return failure(ErrorCode::kInvalidArgument,
                   fmt::format("camera is {} x {}, expected the image's {} x {}", camera.width, camera.height, width, height));
  if (const Result<void> valid = validate(camera); !valid) return tl::unexpected<Error>(valid.error());
  return camera;
}

}  // namespace gfp
