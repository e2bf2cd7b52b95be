#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gfp/core/error.hpp"

namespace gfp {

enum class DistortionModel { kNone, kPlumbBob, kRationalPolynomial };

/// Pinhole camera; camera frame x right, y down, z forward (REP 103 optical). Pixel centres are at integers.
/// u = fx x/z + cx, v = fy y/z + cy. `coefficients` follow OpenCV's order (k1 k2 p1 p2 k3 ...).
struct CameraModel {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  DistortionModel distortion = DistortionModel::kNone;
  std::vector<double> coefficients;

  Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }
  friend bool operator==(const CameraModel&, const CameraModel&) = default;
};

/// Errors: kInvalidArgument naming the member, its value and its bound (sides in [1, kMaxImageSide], focal lengths
/// in (0, 1e5], all finite).
Result<void> validate(const CameraModel& camera);

/// From what calibrations say: K (3 x 3, row-major), the name of the distortion model as in ROS and Foxglove (`plumb_bob`,
/// `rational_polynomial`, empty) and its coefficients; all zero is none. Errors: as validate(), kUnsupported (another model).
Result<CameraModel> camera_from_matrix(std::uint32_t width, std::uint32_t height, std::span<const double, 9> K, std::string_view distortion_model,
                                       std::vector<double> coefficients);

/// 640x480, fx = fy = 525: the usual Kinect v1 / Xtion depth camera, used where nothing better is known.
CameraModel default_kinect_camera(int width = 640, int height = 480);

}  // namespace gfp
