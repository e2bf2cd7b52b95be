#include "registration/class_prior.hpp"

#include <Eigen/Dense>

namespace gfp {

void SizeBelief::observe(const Eigen::Vector3d& weights, double value, double sigma) {
  const Eigen::Vector3d gain = covariance_ * weights / (weights.dot(covariance_ * weights) + sigma * sigma);
  mean_ += gain * (value - weights.dot(mean_));
  covariance_ -= gain * (weights.transpose() * covariance_);
}

double prior_energy(const Primitive& primitive, const Eigen::Vector3d& log_size, const Eigen::VectorXd& modes) {
  const Eigen::Vector3d deviation = log_size - primitive.log_size_mean;
  return 0.5 * deviation.dot(primitive.log_size_covariance.ldlt().solve(deviation)) + 0.5 * modes.squaredNorm();
}

}  // namespace gfp
