#pragma once

#include <string>
#include <string_view>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/time.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// What is read of the messages that ROS 2 records (CDR). Sizes are checked before anything is allocated.
/// Errors of all: kCorruptData, kTooLarge, kUnsupported naming the encoding.

/// The stamp in the header of any stamped message.
Result<Nanoseconds> ros_stamp(std::string_view message);

/// sensor_msgs/Image: 16UC1 or mono16 (millimetres, or `scale_m`), 32FC1 (metres, NaN is no reading).
Result<DepthImage> depth_from_ros_image(std::string_view message, double scale_m);
/// sensor_msgs/CompressedImage of compressed_depth_image_transport: `16UC1; compressedDepth png` and the same of 32FC1.
Result<DepthImage> depth_from_ros_compressed(std::string_view message, double scale_m);
/// sensor_msgs/Image: rgb8, bgr8, mono8.
Result<Image<Rgb8>> color_from_ros_image(std::string_view message);
/// sensor_msgs/CameraInfo.
Result<CameraModel> camera_from_ros_info(std::string_view message);

}  // namespace gfp
