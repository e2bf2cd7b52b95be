#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"
#include "gfp/frame/stereo_calibration.hpp"

namespace gfp::config {

/// Reads a stereo calibration:
/// - OpenCV's YAML, as its stereo_calib sample and `gfp calibrate` write it: M1 D1 M2 D2 R T, width and height (or `image_size: [w, h]`); T in metres;
///   optionally T_world_sensor;
/// - ROS: `left.yaml,right.yaml`, two camera_info files with camera_matrix, distortion_coefficients, rectification_matrix and projection_matrix.
/// Errors: kNotFound, kIo, kTooLarge, kCorruptData, kInvalidArgument (what is missing, or wrong by validate(StereoCalibration)); they name the file.
Result<StereoCalibration> load_stereo_calibration(const std::string& file_or_files);

/// The same from texts; `source` is what errors name.
Result<StereoCalibration> parse_opencv_stereo(std::string_view text, const std::string& source);
Result<StereoCalibration> parse_ros_stereo(std::string_view left, std::string_view right, const std::string& source);

/// As parse_opencv_stereo() reads it.
std::string to_opencv_yaml(const StereoCalibration& calibration);

}  // namespace gfp::config
