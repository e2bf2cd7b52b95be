#pragma once

#include <cstdint>
#include <vector>

#include "gfp/cloud/stereo_to_depth.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/frame/stereo_calibration.hpp"
#include "gfp/frame/stereo_pair.hpp"

namespace gfp {

/// Where every pixel of one rectified picture comes from, to 1/128 of a pixel.
struct RemapTable {
  int width = 0, height = 0;
  std::vector<std::int32_t> source;        ///< Index of the upper left of four pixels; -1: outside.
  std::vector<std::uint8_t> right, below;  ///< Weights of its neighbours, in 128ths.
};

/// A calibrated pair made row-aligned (A. Fusiello, E. Trucco, A. Verri, MVA 2000): both cameras are turned about their centres so that the rows lie along
/// the baseline and the axes are the mean of the two. Immutable: safe from any thread.
class StereoRectifier {
 public:
  /// Errors: those of validate(StereoCalibration).
  static Result<StereoRectifier> make(const StereoCalibration& calibration);

  const RectifiedStereo& geometry() const { return geometry_; }
  const Eigen::Matrix3d& rotation_left() const { return rotations_[0]; }  ///< Left camera to rectified camera.
  const Eigen::Matrix3d& rotation_right() const { return rotations_[1]; }

  /// Bilinear; black outside. Errors: kCorruptFrame (a picture is not of the calibration's size).
  Result<StereoPair> rectify(const StereoPair& pair) const;

 private:
  RectifiedStereo geometry_;
  Eigen::Matrix3d rotations_[2];
  RemapTable tables_[2];
};

/// Rectifier and matcher as a stereo driver takes them. The frame's camera is the rectified left one.
StereoToFrame stereo_to_frame(StereoRectifier rectifier, const StereoOptions& options, const Transform& T_world_sensor);

}  // namespace gfp
