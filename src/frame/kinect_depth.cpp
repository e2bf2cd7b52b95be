#include "gfp/frame/kinect_depth.hpp"

#include <cmath>

namespace gfp {

KinectDepthTable kinect_depth_table(const KinectDepthCalibration& calibration) {
  KinectDepthTable table{};
  for (int raw = 0; raw < kKinectNoReading; ++raw) {
    const double inverse = calibration.inverse_offset_per_m + calibration.inverse_slope_per_m * raw;
    const double units = inverse > 0 ? 1 / inverse / kKinectDepthScale_m : 0;
    if (units < 65535.5) table[static_cast<std::size_t>(raw)] = static_cast<std::uint16_t>(units + 0.5);
  }
  return table;
}

std::uint16_t kinect_raw_of(double depth_m, const KinectDepthCalibration& calibration) {
  if (!(depth_m > 0)) return kKinectNoReading;
  const double raw = std::floor((1 / depth_m - calibration.inverse_offset_per_m) / calibration.inverse_slope_per_m + 0.5);
  return raw >= 0 && raw < kKinectNoReading ? static_cast<std::uint16_t>(raw) : kKinectNoReading;
}

}  // namespace gfp
