#pragma once

#include <Eigen/Core>

// The paper's equations as they are printed, to pin what is wrong with them; what is built are the sensible readings (PAPER P15-P28).

namespace gfp::test::printed {

/// Eq. 1: M_new = s R (M_old + T).
inline Eigen::Vector3d place(const Eigen::Vector3d& p, double s, const Eigen::Matrix3d& R, const Eigen::Vector3d& T) { return s * (R * (p + T)); }

/// Eq. 4: squared first differences along the two surface axes.
inline double continuity(const Eigen::Vector3d& p, const Eigen::Vector3d& before_s, const Eigen::Vector3d& before_r) {
  return (p - before_s).squaredNorm() + (p - before_r).squaredNorm();
}

/// Eq. 5, the mixed term: |p_(i-1)(s, r) - 2 p_i(s, r) + p_(i+1)(s, r)|^2, a second difference along the diagonal.
inline double mixed_curvature(const Eigen::Vector3d& before, const Eigen::Vector3d& p, const Eigen::Vector3d& after) { return (before - 2 * p + after).squaredNorm(); }

/// Eq. 6, of one point: the external energy and squared derivatives, added and subtracted; 0 is called equilibrium.
inline double equilibrium(double external, double alpha, double squared_first, double beta, double squared_second) { return external + alpha * squared_first - beta * squared_second; }

/// Eq. 7: M_new = M_old (1 + d / d_max).
inline Eigen::Vector3d drag(const Eigen::Vector3d& p, double d, double d_max) { return p * (1 + d / d_max); }

/// Eq. 8 of one point: 1 / (1 + gamma d^2), called an error.
inline double fit_error(double d, double gamma) { return 1 / (1 + gamma * d * d); }

}  // namespace gfp::test::printed
