#include "gfp/frame/stereo_calibration.hpp"

#include <fmt/format.h>

namespace gfp {

Result<void> validate(const StereoCalibration& calibration) {
  if (auto left = validate(calibration.left); !left) return failure(left.error().code, "left " + left.error().what);
  if (auto right = validate(calibration.right); !right) return failure(right.error().code, "right " + right.error().what);
  if (calibration.left.width != calibration.right.width || calibration.left.height != calibration.right.height)
    return failure(ErrorCode::kInvalidArgument, fmt::format("stereo cameras are {} x {} and {} x {}, expected equal sizes", calibration.left.width, calibration.left.height,
                                                            calibration.right.width, calibration.right.height));
  const Eigen::Matrix3d R = calibration.T_right_left.linear();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 && R.determinant() > 0)) return failure(ErrorCode::kInvalidArgument, "stereo R is no rotation");
  const double baseline_m = calibration.baseline_m();
  if (!(baseline_m >= 0.01 && baseline_m <= 2)) return failure(ErrorCode::kInvalidArgument, fmt::format("stereo baseline = {} m, expected [0.01, 2] m (T in metres)", baseline_m));
  const Eigen::Vector3d right_in_left = calibration.T_right_left.inverse().translation();
  if (!(right_in_left.x() > 0.5 * baseline_m)) return failure(ErrorCode::kInvalidArgument, fmt::format("the right camera stands {} m to the right of the left one, expected most of the baseline", right_in_left.x()));
  return {};
}

}  // namespace gfp
