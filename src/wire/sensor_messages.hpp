#pragma once

#include <span>

#include "gfp/core/error.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/v1/sensor.pb.h"

namespace gfp::wire {

/// Headers only: the pixels travel beside them, as the message's blob.
void fill_depth(const Frame& frame, v1::DepthImage& message);
void fill_color(const Frame& frame, v1::ColorImage& message);
void fill_camera(const Frame& frame, v1::CameraInfo& message);

/// Everything of a frame but its images. Errors: kInvalidArgument (camera), kCorruptData.
Result<void> camera_into(const v1::CameraInfo& message, Frame& frame);

/// The bytes of an image's pixels as they travel, for as long as the image lives.
std::span<const std::byte> depth_blob(const Frame& frame);
std::span<const std::byte> color_blob(const Frame& frame);

/// Errors: kTooLarge (a side beyond kMaxImageSide), kCorruptData (a blob of another size).
Result<DepthImage> depth_from(const v1::DepthImage& message, std::span<const std::byte> blob);
Result<Image<Rgb8>> color_from(const v1::ColorImage& message, std::span<const std::byte> blob);

}  // namespace gfp::wire
