#pragma once

#include <Eigen/Geometry>

namespace gfp {

/// T_a_b maps b coordinates into a: p_a = T_a_b * p_b. Inner names meet in products.
using Transform = Eigen::Isometry3d;

/// Rotation by the rotation vector `omega` (axis * angle, radians); exact at 0.
Eigen::Matrix3d rotation_from_vector(const Eigen::Vector3d& omega);

/// The rotation vector of R, |omega| <= pi.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

/// Two unit vectors that complete `axis` (unit) to a right-handed frame (first, second, axis).
std::pair<Eigen::Vector3d, Eigen::Vector3d> orthonormal_basis(const Eigen::Vector3d& axis);

}  // namespace gfp
