#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/core/transform.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Where a primitive stands, how large it is and which of its shapes it has; `cost` compares placements of one object.
struct Placement {
  PrimitivePtr primitive;
  int hypothesis = 0;                            ///< Which of the given hypotheses it is a placement of.
  Transform T_camera_object = Transform::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
  std::vector<double> modes;                     ///< Coefficients in standard deviations.
  int stable_pose = 0;
  double cost = 0;                               ///< Mean capped per-pixel negative log likelihood plus priors; lower is better.
  int iterations = 0;
  bool converged = false;
  Eigen::MatrixXd covariance;                    ///< Of (x, y, z, rx, ry, rz, log size 3, modes...), support-frame tangent; may be empty.
  double yaw_low_rad = 0, yaw_high_rad = 0;      ///< Yaw interval relative to T_camera_object that explains the view as well; [-pi, pi] where yaw means nothing.
};

/// Where a body of known shape is now.
struct FollowedPose {
  Transform T_camera_object = Transform::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< x y z rx ry rz, support-frame tangent.
};

}  // namespace gfp
