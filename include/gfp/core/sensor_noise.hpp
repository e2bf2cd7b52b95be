#pragma once

namespace gfp {

/// Standard deviation of a depth reading in metres: sigma(z) = base + quadratic (z - reference)^2.
/// The defaults are Kinect v1's (Nguyen, Izadi, Lovell, 3DIMPVT 2012); stereo: quadratic = sigma_disparity / (f B).
struct SensorNoise {
  double base_m = 0.0012;
  double quadratic_per_m = 0.0019;
  double reference_m = 0.4;

  double sigma_m(double depth_m) const {
    const double excess = depth_m > reference_m ? depth_m - reference_m : 0.0;
    return base_m + quadratic_per_m * excess * excess;
  }
};

}  // namespace gfp
