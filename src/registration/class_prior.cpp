#include "registration/class_prior.hpp"

#include <Eigen/Dense>

namespace gfp {

void SizeBelief::observe(const Eigen::Vector3d& weights, double value, double sigma) {
  const Eigen::Vector3d gain = covariance_ * weights / (weights.dot(covariance_ * weights) + sigma * sigma);
  mean_ += gain * (value - weights.dot(mean_));
  covariance_ -= gain * (weights.transpose() * covariance_);
}

}  // namespace gfp
