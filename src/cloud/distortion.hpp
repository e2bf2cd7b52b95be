#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>

#include "gfp/core/camera_model.hpp"

namespace gfp {

/// A lens in OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6, on normalised coordinates (x / z, y / z). Plumb bob is the rational model with k4 = k5 = k6 = 0.
struct Distortion {
  std::array<double, 8> k{};

  explicit Distortion(const CameraModel& camera) {
    const std::size_t known = camera.distortion == DistortionModel::kPlumbBob ? 5 : 8;
    for (std::size_t i = 0; i < std::min(known, camera.coefficients.size()); ++i) k[i] = camera.coefficients[i];
  }

  Eigen::Vector2d apply(const Eigen::Vector2d& p) const {
    const double r2 = p.squaredNorm(), xy = p.x() * p.y();
    const double radial = (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
    return {p.x() * radial + 2 * k[2] * xy + k[3] * (r2 + 2 * p.x() * p.x()),
            p.y() * radial + k[2] * (r2 + 2 * p.y() * p.y()) + 2 * k[3] * xy};
  }

  Eigen::Matrix2d jacobian(const Eigen::Vector2d& p) const {
    constexpr double kStep = 1e-6;
    const Eigen::Vector2d dx(kStep, 0), dy(0, kStep);
    Eigen::Matrix2d j;
    j.col(0) = (apply(p + dx) - apply(p - dx)) / (2 * kStep);
    j.col(1) = (apply(p + dy) - apply(p - dy)) / (2 * kStep);
    return j;
  }

  // Newton from the distorted position: the nearest branch, which is the one the lens has.
  Eigen::Vector2d invert(const Eigen::Vector2d& distorted) const {
    Eigen::Vector2d p = distorted;
    for (int iteration = 0; iteration < 30; ++iteration) {
      const Eigen::Vector2d error = apply(p) - distorted;
      if (error.squaredNorm() < 1e-18) return p;
      const Eigen::Matrix2d j = jacobian(p);
      if (!(j.determinant() > 1e-6)) break;  // folded over: no pixel of a real lens lies here
      p -= j.inverse() * error;
    }
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
};

}  // namespace gfp
