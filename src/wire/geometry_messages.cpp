#include "wire/geometry_messages.hpp"

#include <fmt/format.h>

namespace gfp::wire {

void fill(const Eigen::Vector3d& vector, v1::Vector3& message) {
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
}

void fill(const Transform& transform, v1::Transform& message) {
  message.clear_matrix();
  message.mutable_matrix()->Reserve(16);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) message.add_matrix(transform.matrix()(row, column));
}

void fill(const CameraModel& camera, v1::Camera& message) {
  message.set_width(static_cast<std::uint32_t>(camera.width));
  message.set_height(static_cast<std::uint32_t>(camera.height));
  message.set_fx(camera.fx);
  message.set_fy(camera.fy);
  message.set_cx(camera.cx);
  message.set_cy(camera.cy);
  message.set_distortion(static_cast<v1::Camera::Distortion>(camera.distortion));  // the same numbers: checked below
  message.mutable_coefficients()->Assign(camera.coefficients.begin(), camera.coefficients.end());
}
static_assert(static_cast<int>(DistortionModel::kPlumbBob) == v1::Camera::DISTORTION_PLUMB_BOB);
static_assert(static_cast<int>(DistortionModel::kRationalPolynomial) == v1::Camera::DISTORTION_RATIONAL_POLYNOMIAL);

void fill(const std::string& sensor, std::uint64_t sequence, const Stamps& stamps, v1::FrameHeader& message) {
  message.set_sensor(sensor);
  message.set_frame_id(frame_id_of(sensor));
  message.set_sequence(sequence);
  message.set_stamp_sensor_ns(stamps.sensor.count());
  message.set_stamp_monotonic_ns(stamps.monotonic.count());
  message.set_stamp_capture_ns(stamps.realtime.count());
}

Eigen::Vector3d vector_from(const v1::Vector3& message) { return {message.x(), message.y(), message.z()}; }

Stamps stamps_from(const v1::FrameHeader& message) {
  return {Nanoseconds(message.stamp_sensor_ns()), Nanoseconds(message.stamp_monotonic_ns()), Nanoseconds(message.stamp_capture_ns())};
}

Result<Transform> transform_from(const v1::Transform& message, const char* what) {
  if (message.matrix_size() != 16)
    return failure(ErrorCode::kCorruptData, fmt::format("{} has {} numbers, expected 16", what, message.matrix_size()));
  Transform transform = Transform::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) transform.matrix()(row, column) = message.matrix(4 * row + column);
  const Eigen::Matrix3d rotation = transform.linear();
  if (!transform.matrix().allFinite() || !(rotation * rotation.transpose()).isIdentity(1e-6) || rotation.determinant() < 0)
    return failure(ErrorCode::kCorruptData, fmt::format("{} is not a rigid transform", what));
  return transform;
}

Result<CameraModel> camera_from(const v1::Camera& message) {
  if (message.coefficients_size() > 64)
    return failure(ErrorCode::kTooLarge, fmt::format("camera has {} coefficients, at most 64 are read", message.coefficients_size()));
  CameraModel camera;
  camera.width = static_cast<int>(std::min(message.width(), 1U << 20));
  camera.height = static_cast<int>(std::min(message.height(), 1U << 20));
  camera.fx = message.fx(), camera.fy = message.fy(), camera.cx = message.cx(), camera.cy = message.cy();
  if (message.distortion() == v1::Camera::DISTORTION_PLUMB_BOB) camera.distortion = DistortionModel::kPlumbBob;
  if (message.distortion() == v1::Camera::DISTORTION_RATIONAL_POLYNOMIAL) camera.distortion = DistortionModel::kRationalPolynomial;
  camera.coefficients.assign(message.coefficients().begin(), message.coefficients().end());
  if (Result<void> valid = validate(camera); !valid) return tl::unexpected(valid.error());
  return camera;
}

}  // namespace gfp::wire
