#include "wire/sensor_messages.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "wire/geometry_messages.hpp"

namespace gfp::wire {
namespace {

static_assert(sizeof(Rgb8) == 3, "colour pixels are copied as r g b bytes");

template <class Message>
void fill_image(const Frame& frame, int width, int height, Message& message) {
  fill(frame.sensor, frame.sequence, frame.stamps, *message.mutable_header());
  message.set_width(static_cast<std::uint32_t>(width));
  message.set_height(static_cast<std::uint32_t>(height));
}

template <class Pixel>
Result<Image<Pixel>> image_from(std::uint32_t width, std::uint32_t height, std::span<const std::byte> blob) {
  if (width > kMaxImageSide || height > kMaxImageSide)
    return failure(ErrorCode::kTooLarge, fmt::format("image is {} x {}, at most {} a side", width, height, kMaxImageSide));
  const std::size_t expected = static_cast<std::size_t>(width) * height * sizeof(Pixel);
  if (blob.size() != expected) return failure(ErrorCode::kCorruptData, fmt::format("image has {} bytes, expected {}", blob.size(), expected));
  Image<Pixel> image(static_cast<int>(width), static_cast<int>(height));
  if (expected > 0) std::memcpy(static_cast<void*>(image.pixels.data()), blob.data(), expected);
  return image;
}

}  // namespace

void fill_depth(const Frame& frame, v1::DepthImage& message) {
  fill_image(frame, frame.depth.pixels.width, frame.depth.pixels.height, message);
  message.set_scale_m(frame.depth.scale_m);
}

void fill_color(const Frame& frame, v1::ColorImage& message) { fill_image(frame, frame.color.width, frame.color.height, message); }

void fill_camera(const Frame& frame, v1::CameraInfo& message) {
  fill(frame.sensor, frame.sequence, frame.stamps, *message.mutable_header());
  fill(frame.camera, *message.mutable_camera());
  fill(frame.T_world_sensor, *message.mutable_t_world_sensor());
  if (frame.up_camera) fill(*frame.up_camera, *message.mutable_up_camera());
  message.mutable_noise()->set_base_m(frame.noise.base_m);
  message.mutable_noise()->set_quadratic_per_m(frame.noise.quadratic_per_m);
  message.mutable_noise()->set_reference_m(frame.noise.reference_m);
}

Result<void> camera_into(const v1::CameraInfo& message, Frame& frame) {
  auto camera = camera_from(message.camera());
  if (!camera) return tl::unexpected(camera.error());
  const auto pose = transform_from(message.t_world_sensor(), "camera.T_world_sensor");
  if (!pose) return tl::unexpected(pose.error());
  const v1::SensorNoise& noise = message.noise();
  const auto is_length = [](double value) { return std::isfinite(value) && value >= 0; };
  if (!is_length(noise.base_m()) || !is_length(noise.quadratic_per_m()) || !is_length(noise.reference_m()))
    return failure(ErrorCode::kCorruptData, fmt::format("camera.noise = {}, {}, {}, expected numbers not below 0", noise.base_m(), noise.quadratic_per_m(), noise.reference_m()));
  frame.sensor = message.header().sensor();
  frame.sequence = message.header().sequence();
  frame.stamps = stamps_from(message.header());
  frame.camera = std::move(*camera);
  frame.T_world_sensor = *pose;
  if (message.has_up_camera()) frame.up_camera = vector_from(message.up_camera());
  if (message.has_noise()) frame.noise = {noise.base_m(), noise.quadratic_per_m(), noise.reference_m()};
  return {};
}

std::span<const std::byte> depth_blob(const Frame& frame) { return std::as_bytes(std::span(frame.depth.pixels.pixels)); }
std::span<const std::byte> color_blob(const Frame& frame) { return std::as_bytes(std::span(frame.color.pixels)); }

Result<DepthImage> depth_from(const v1::DepthImage& message, std::span<const std::byte> blob) {
  auto pixels = image_from<std::uint16_t>(message.width(), message.height(), blob);
  if (!pixels) return tl::unexpected(pixels.error());
  return DepthImage{std::move(*pixels), message.scale_m()};
}

Result<Image<Rgb8>> color_from(const v1::ColorImage& message, std::span<const std::byte> blob) {
  return image_from<Rgb8>(message.width(), message.height(), blob);
}

}  // namespace gfp::wire
