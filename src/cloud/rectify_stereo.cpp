#include "gfp/cloud/rectify_stereo.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "cloud/distortion.hpp"

namespace gfp {
namespace {

constexpr int kWeight = 128;

/// Pixel coordinates of the rectified camera at centre 0 where the corners of the picture come to lie.
Eigen::Vector2d mean_of_corners(const CameraModel& camera, const Eigen::Matrix3d& rotation, double focal_px) {
  const Distortion lens(camera);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const double u : {0.0, camera.width - 1.0})
    for (const double v : {0.0, camera.height - 1.0}) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      Eigen::Vector2d straight = lens.invert(ray.head<2>());
      if (!straight.allFinite()) straight = ray.head<2>();
      sum += 0.25 * focal_px * (rotation * straight.homogeneous()).hnormalized();
    }
  return sum;
}

RemapTable table_of(const CameraModel& from, const Eigen::Matrix3d& rotation, const CameraModel& to) {
  const Distortion lens(from);
  RemapTable table{to.width, to.height, {}, {}, {}};
  for (int v = 0; v < to.height; ++v)
    for (int u = 0; u < to.width; ++u) {
      const Eigen::Vector2d bent = lens.apply((rotation.transpose() * to.ray(u, v)).hnormalized());
      const double x = from.fx * bent.x() + from.cx, y = from.fy * bent.y() + from.cy;
      const bool inside = x >= 0 && y >= 0 && x < from.width - 1 && y < from.height - 1;
      const int column = inside ? static_cast<int>(x) : 0, row = inside ? static_cast<int>(y) : 0;
      table.source.push_back(inside ? row * from.width + column : -1);
      table.right.push_back(static_cast<std::uint8_t>(inside ? std::lround(kWeight * (x - column)) : 0));
      table.below.push_back(static_cast<std::uint8_t>(inside ? std::lround(kWeight * (y - row)) : 0));
    }
  return table;
}

int blend(int a, int b, int c, int d, int right, int below) {
  const int upper = (kWeight - right) * a + right * b, lower = (kWeight - right) * c + right * d;
  return ((kWeight - below) * upper + below * lower + kWeight * kWeight / 2) / (kWeight * kWeight);
}

template <class Pixel, class Blend>
Image<Pixel> remap(const Image<Pixel>& image, const RemapTable& table, Blend&& blend_pixels) {
  Image<Pixel> result(table.width, table.height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    if (table.source[i] < 0) continue;
    const Pixel* const at = &image.pixels[static_cast<std::size_t>(table.source[i])];
    result.pixels[i] = blend_pixels(at[0], at[1], at[image.width], at[image.width + 1], table.right[i], table.below[i]);
  }
  return result;
}

Image<std::uint8_t> remap_grey(const Image<std::uint8_t>& image, const RemapTable& table) {
  return remap(image, table, [](int a, int b, int c, int d, int right, int below) { return static_cast<std::uint8_t>(blend(a, b, c, d, right, below)); });
}

Image<Rgb8> remap_color(const Image<Rgb8>& image, const RemapTable& table) {
  return remap(image, table, [](Rgb8 a, Rgb8 b, Rgb8 c, Rgb8 d, int right, int below) {
    const auto part = [&](std::uint8_t Rgb8::*p) { return static_cast<std::uint8_t>(blend(a.*p, b.*p, c.*p, d.*p, right, below)); };
    return Rgb8{part(&Rgb8::r), part(&Rgb8::g), part(&Rgb8::b)};
  });
}

template <class Pixel>
bool has_size(const Image<Pixel>& image, const CameraModel& camera) {
  return image.width == camera.width && image.height == camera.height;
}

}  // namespace

Result<StereoRectifier> StereoRectifier::make(const StereoCalibration& calibration) {
  if (const auto valid = validate(calibration); !valid) return tl::unexpected<Error>(valid.error());
  const Eigen::Matrix3d R = calibration.T_right_left.linear();
  const Eigen::Vector3d across = calibration.T_right_left.inverse().translation().normalized();  // from the left camera to the right one
  const Eigen::Vector3d ahead = (Eigen::Vector3d::UnitZ() + R.transpose() * Eigen::Vector3d::UnitZ()).normalized();
  StereoRectifier made;
  made.rotations_[0].row(0) = across;
  made.rotations_[0].row(1) = ahead.cross(across).normalized();
  made.rotations_[0].row(2) = across.cross(made.rotations_[0].row(1).transpose());
  made.rotations_[1] = made.rotations_[0] * R.transpose();
  CameraModel& camera = made.geometry_.camera;
  camera.width = calibration.left.width, camera.height = calibration.left.height;
  camera.fx = camera.fy = 0.5 * (calibration.left.fy + calibration.right.fy);
  const Eigen::Vector2d shift = 0.5 * (mean_of_corners(calibration.left, made.rotations_[0], camera.fx) + mean_of_corners(calibration.right, made.rotations_[1], camera.fx));
  camera.cx = 0.5 * (camera.width - 1) - shift.x();
  camera.cy = 0.5 * (camera.height - 1) - shift.y();
  made.geometry_.baseline_m = calibration.baseline_m();
  made.tables_[0] = table_of(calibration.left, made.rotations_[0], camera);
  made.tables_[1] = table_of(calibration.right, made.rotations_[1], camera);
  return made;
}

Result<StereoPair> StereoRectifier::rectify(const StereoPair& pair) const {
  const CameraModel& camera = geometry_.camera;
  if (!has_size(pair.left, camera) || !has_size(pair.right, camera) || !(pair.color.empty() || has_size(pair.color, camera)))
    return failure(ErrorCode::kCorruptFrame, "wrong_size: the stereo pair is " + std::to_string(pair.left.width) + " x " + std::to_string(pair.left.height) + ", expected the calibration's " +
                                                 std::to_string(camera.width) + " x " + std::to_string(camera.height));
  StereoPair rectified{remap_grey(pair.left, tables_[0]), remap_grey(pair.right, tables_[1]), {}};
  if (!pair.color.empty()) rectified.color = remap_color(pair.color, tables_[0]);
  return rectified;
}

StereoToFrame stereo_to_frame(StereoRectifier rectifier, const StereoOptions& options, const Transform& T_world_sensor) {
  auto shared = std::make_shared<const StereoRectifier>(std::move(rectifier));  // a std::function is copied
  return [shared, options, T_world_sensor](const StereoPair& pair, Frame& frame) -> Result<void> {
    auto rectified = shared->rectify(pair);
    if (!rectified) return tl::unexpected<Error>(rectified.error());
    auto depth = stereo_to_depth(rectified->left, rectified->right, shared->geometry(), options);
    if (!depth) return tl::unexpected<Error>(depth.error());
    frame.depth = std::move(*depth);
    frame.color = std::move(rectified->color);
    frame.camera = shared->geometry().camera;
    frame.noise = stereo_noise(shared->geometry(), options);
    frame.T_world_sensor = T_world_sensor;
    return {};
  };
}

}  // namespace gfp
