#pragma once

#include <array>
#include <cstdint>

namespace gfp {

/// How a Kinect v1's raw 11-bit depth becomes metres: 1 / z = inverse_offset_per_m + inverse_slope_per_m * raw, linear since raw is
/// disparity in eighths of a pixel. The defaults are the usual ones (N. Burrus, Kinect calibration, 2010); devices differ by some
/// per cent, which calibration against a measured wall tells.
struct KinectDepthCalibration {
  double inverse_offset_per_m = 3.3309495161;
  double inverse_slope_per_m = -0.0030711016;
};

template <class Visitor>
void visit_fields(KinectDepthCalibration& o, Visitor&& field) {
  field("inverse_offset_per_m", o.inverse_offset_per_m, 1.0, 10.0);
  field("inverse_slope_per_m", o.inverse_slope_per_m, -0.02, -0.0005);
}

inline constexpr int kKinectRawValues = 2048;
inline constexpr std::uint16_t kKinectNoReading = 2047;
inline constexpr double kKinectDepthScale_m = 2e-4;  ///< Of converted depth: finer than the finest step (0.5 mm at 0.4 m), holds 13 m.

/// 16-bit depth in units of kKinectDepthScale_m for each raw value; 0 where that is no reading (no distance, or beyond 13 m).
using KinectDepthTable = std::array<std::uint16_t, kKinectRawValues>;
KinectDepthTable kinect_depth_table(const KinectDepthCalibration& calibration = {});

/// The raw value whose depth is nearest; kKinectNoReading for depths that have none (0, NaN, nearer than raw 0).
std::uint16_t kinect_raw_of(double depth_m, const KinectDepthCalibration& calibration = {});

}  // namespace gfp
