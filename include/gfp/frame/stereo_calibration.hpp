#pragma once

#include "gfp/core/camera_model.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {

/// Two cameras and how the right one stands to the left one. Reading the files is the configuration's job.
struct StereoCalibration {
  CameraModel left, right;                                  ///< With their lenses' distortion; equal sizes.
  Transform T_right_left = Transform::Identity();           ///< Maps the left camera's coordinates to the right one's: OpenCV's R and T, in metres.
  Transform T_world_sensor = Transform::Identity();         ///< Of the rectified left camera.

  double baseline_m() const { return T_right_left.translation().norm(); }
};

/// Errors: kInvalidArgument naming the member (cameras of different sizes, a baseline outside [0.01, 2] m, a right camera that stands to the left).
Result<void> validate(const StereoCalibration& calibration);

}  // namespace gfp
