#pragma once

#include <Eigen/Core>

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// What is believed of log(reference size) given measurements of it: a Gaussian that linear observations sharpen.
class SizeBelief {
 public:
  explicit SizeBelief(const Primitive& primitive) : mean_(primitive.log_size_mean), covariance_(primitive.log_size_covariance) {}

  /// Kalman update with `weights . log_size = value`, standard deviation `sigma` (log metres).
  void observe(const Eigen::Vector3d& weights, double value, double sigma);

  const Eigen::Vector3d& mean() const { return mean_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  Eigen::Vector3d mean_;
  Eigen::Matrix3d covariance_;
};

}  // namespace gfp
