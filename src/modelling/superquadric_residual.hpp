#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gfp/modelling/superquadric.hpp"

namespace gfp {

/// Order of a step: translation (frame of the pose, metres), rotation (body, tangent at the right, radians), logarithms of a1 a2 a3,
/// epsilon1, epsilon2.
inline constexpr int kSuperquadricParameters = 11;
using SuperquadricStep = Eigen::Matrix<double, kSuperquadricParameters, 1>;
enum SuperquadricIndex { kTranslation = 0, kRotation = 3, kLogAxes = 6, kEpsilon1 = 9, kEpsilon2 = 10 };

struct SuperquadricLimits {
  double min_half_axis_m = 0.001, max_half_axis_m = 1.0;
  double min_epsilon = 0.1, max_epsilon = 1.9;  ///< Beyond, the data cannot tell and the derivatives fade.
};

/// The superquadric after a step, within the limits.
Superquadric stepped(const Superquadric& superquadric, const SuperquadricStep& step, const SuperquadricLimits& limits);

/// A signed length in metres with its derivative by a step.
struct LinearisedLength {
  double value = 0;
  SuperquadricStep derivative = SuperquadricStep::Zero();
};

/// gauge() with its derivative by a step and the length of its gradient in space.
struct LinearisedGauge {
  double value = 0, slope = 0;
  SuperquadricStep derivative = SuperquadricStep::Zero();
};
std::vector<LinearisedGauge> linearised_gauges(const Superquadric& superquadric, std::span<const Eigen::Vector3d> points);

/// reach() in `direction` (unit).
LinearisedLength linearised_reach(const Superquadric& superquadric, const Eigen::Vector3d& direction);

/// A half line; `direction` is a unit vector.
struct Ray {
  Eigen::Vector3d origin, direction;
};

/// Of each line the point with the smallest gauge: where it touches the surface or is deepest inside.
std::vector<Eigen::Vector3d> deepest_points(const Superquadric& superquadric, std::span<const Ray> rays);

}  // namespace gfp
