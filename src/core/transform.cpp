#include "gfp/core/transform.hpp"

#include <utility>

namespace gfp {

Eigen::Matrix3d rotation_from_vector(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  if (angle < 1e-12) {  // first order: exact to the last bit at this size
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    rotation(0, 1) = -omega.z(); rotation(1, 0) = omega.z();
    rotation(0, 2) = omega.y();  rotation(2, 0) = -omega.y();
    rotation(1, 2) = -omega.x(); rotation(2, 1) = omega.x();
    return rotation;
  }
  return Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix();
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> orthonormal_basis(const Eigen::Vector3d& axis) {
  // Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017: continuous except at z = -1.
  const double sign = axis.z() < 0 ? -1.0 : 1.0;
  const double a = -1.0 / (sign + axis.z());
  const double b = axis.x() * axis.y() * a;
  return {{1.0 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x()},
          {b, sign + axis.y() * axis.y() * a, -axis.y()}};
}

}  // namespace gfp
