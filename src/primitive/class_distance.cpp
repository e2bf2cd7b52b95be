#include "gfp/primitive/class_distance.hpp"

#include <Eigen/Dense>

namespace gfp {

double class_distance_squared(const Primitive& primitive, const Eigen::Vector3d& log_size, const Eigen::VectorXd& modes) {
  const Eigen::Vector3d deviation = log_size - primitive.log_size_mean;
  return deviation.dot(primitive.log_size_covariance.ldlt().solve(deviation)) + modes.squaredNorm();
}

}  // namespace gfp
