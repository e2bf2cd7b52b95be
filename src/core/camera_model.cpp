#include "gfp/core/camera_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "gfp/core/image.hpp"

namespace gfp {
namespace {

std::string bound_message(const char* name, double value, const char* bound) {
  return std::string("camera.") + name + " = " + std::to_string(value) + ", expected " + bound;
}

}  // namespace

Result<void> validate(const CameraModel& camera) {
  const auto side_ok = [](int side) { return side >= 1 && side <= kMaxImageSide; };
  if (!side_ok(camera.width)) return failure(ErrorCode::kInvalidArgument, bound_message("width", camera.width, "[1, 8192]"));
  if (!side_ok(camera.height)) return failure(ErrorCode::kInvalidArgument, bound_message("height", camera.height, "[1, 8192]"));
  const auto focal_ok = [](double f) { return std::isfinite(f) && f > 0 && f <= 1e5; };
  if (!focal_ok(camera.fx)) return failure(ErrorCode::kInvalidArgument, bound_message("fx", camera.fx, "(0, 1e5] pixels"));
  if (!focal_ok(camera.fy)) return failure(ErrorCode::kInvalidArgument, bound_message("fy", camera.fy, "(0, 1e5] pixels"));
  if (!(std::abs(camera.cx) <= 1e5)) return failure(ErrorCode::kInvalidArgument, bound_message("cx", camera.cx, "[-1e5, 1e5] pixels"));
  if (!(std::abs(camera.cy) <= 1e5)) return failure(ErrorCode::kInvalidArgument, bound_message("cy", camera.cy, "[-1e5, 1e5] pixels"));
  for (const double c : camera.coefficients)
    if (!std::isfinite(c)) return failure(ErrorCode::kInvalidArgument, bound_message("distortion.coefficients", c, "finite numbers"));
  return {};
}

Result<CameraModel> camera_from_matrix(std::uint32_t width, std::uint32_t height, std::span<const double, 9> K, std::string_view distortion_model,
                                       std::vector<double> coefficients) {
  const auto side = [](std::uint32_t value) { return static_cast<int>(std::min<std::uint32_t>(value, kMaxImageSide + 1)); };
  CameraModel camera{side(width), side(height), K[0], K[4], K[2], K[5], DistortionModel::kNone, {}};
  const bool is_distorted = std::any_of(coefficients.begin(), coefficients.end(), [](double c) { return c != 0; });
  if (is_distorted && distortion_model != "plumb_bob" && distortion_model != "rational_polynomial")
    return failure(ErrorCode::kUnsupported, "camera.distortion = " + std::string(distortion_model.substr(0, 32)) + ", expected plumb_bob or rational_polynomial");
  if (is_distorted) {
    camera.distortion = distortion_model == "plumb_bob" ? DistortionModel::kPlumbBob : DistortionModel::kRationalPolynomial;
    camera.coefficients = std::move(coefficients);
  }
  if (Result<void> valid = validate(camera); !valid) return tl::unexpected(valid.error());
  return camera;
}

CameraModel default_kinect_camera(int width, int height) {
  const double scale = width / 640.0;
  return {width, height, 525.0 * scale, 525.0 * scale, 0.5 * (width - 1), 0.5 * (height - 1), DistortionModel::kNone, {}};
}

}  // namespace gfp
