#include "modelling/superquadric_residual.hpp"

#include <algorithm>
#include <cmath>

#include "modelling/superquadric_norm.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

Vector3d with_signs_of(const Vector3d& magnitude, const Vector3d& sign) {
  return {std::copysign(magnitude.x(), sign.x()), std::copysign(magnitude.y(), sign.y()), std::copysign(magnitude.z(), sign.z())};
}

/// Slope of the gauge along a line through `body` in direction `along`, body coordinates.
double slope_along(const Superquadric& s, const Vector3d& body, const Vector3d& along) {
  const Vector3d unit = body.cwiseQuotient(s.half_axes_m);
  const PNorm across = p_norm(std::abs(unit.x()), std::abs(unit.y()), 2 / s.epsilon2);
  const PNorm whole = p_norm(across.value, std::abs(unit.z()), 2 / s.epsilon1);
  const Vector3d slope = with_signs_of({whole.by_a * across.by_a, whole.by_a * across.by_b, whole.by_b}, unit);
  return slope.dot(along.cwiseQuotient(s.half_axes_m));
}

}  // namespace

Superquadric stepped(const Superquadric& superquadric, const SuperquadricStep& step, const SuperquadricLimits& limits) {
  Superquadric s = superquadric;
  s.pose.translation() += step.segment<3>(kTranslation);
  s.pose.linear() = s.pose.linear() * rotation_from_vector(step.segment<3>(kRotation));
  for (int k = 0; k < 3; ++k) {
    const double factor = std::exp(std::clamp(step[kLogAxes + k], -0.7, 0.7));  // at most doubled in one step
    s.half_axes_m[k] = std::clamp(s.half_axes_m[k] * factor, limits.min_half_axis_m, limits.max_half_axis_m);
  }
  s.epsilon1 = std::clamp(s.epsilon1 + step[kEpsilon1], limits.min_epsilon, limits.max_epsilon);
  s.epsilon2 = std::clamp(s.epsilon2 + step[kEpsilon2], limits.min_epsilon, limits.max_epsilon);
  return s;
}

LinearisedGauge linearised_gauge(const Superquadric& s, const Vector3d& point) {
  const Vector3d body = s.pose.linear().transpose() * (point - s.pose.translation());
  const Vector3d unit = body.cwiseQuotient(s.half_axes_m);
  const PNorm across = p_norm(std::abs(unit.x()), std::abs(unit.y()), 2 / s.epsilon2);
  const PNorm whole = p_norm(across.value, std::abs(unit.z()), 2 / s.epsilon1);
  const Vector3d gradient =
      with_signs_of({whole.by_a * across.by_a, whole.by_a * across.by_b, whole.by_b}, unit).cwiseQuotient(s.half_axes_m);
  LinearisedGauge gauge;
  gauge.value = whole.value;
  gauge.slope = gradient.norm();
  gauge.derivative.segment<3>(kTranslation) = -(s.pose.linear() * gradient);
  gauge.derivative.segment<3>(kRotation) = gradient.cross(body);
  gauge.derivative.segment<3>(kLogAxes) = -gradient.cwiseProduct(body);
  gauge.derivative[kEpsilon1] = whole.by_p * (-2 / (s.epsilon1 * s.epsilon1));
  gauge.derivative[kEpsilon2] = whole.by_a * across.by_p * (-2 / (s.epsilon2 * s.epsilon2));
  return gauge;
}

LinearisedLength linearised_distance(const Superquadric& s, const Vector3d& point) {
  const LinearisedGauge at = linearised_gauge(s, point);
  if (!(at.slope > 0)) return {-s.half_axes_m.minCoeff()};  // at the centre nothing says which way the surface is
  return {(at.value - 1) / at.slope, at.derivative / at.slope};
}

LinearisedLength linearised_reach(const Superquadric& s, const Vector3d& direction) {
  const Vector3d body = s.pose.linear().transpose() * direction;
  const Vector3d scaled = body.cwiseProduct(s.half_axes_m);
  const double q1 = 2 / (2 - s.epsilon1), q2 = 2 / (2 - s.epsilon2);  // dual exponents; epsilon < 2 by the limits
  const PNorm across = p_norm(std::abs(scaled.x()), std::abs(scaled.y()), q2);
  const PNorm whole = p_norm(across.value, std::abs(scaled.z()), q1);
  const Vector3d by_scaled = with_signs_of({whole.by_a * across.by_a, whole.by_a * across.by_b, whole.by_b}, scaled);
  LinearisedLength length;
  length.value = whole.value;
  length.derivative.segment<3>(kRotation) = by_scaled.cwiseProduct(s.half_axes_m).cross(body);
  length.derivative.segment<3>(kLogAxes) = by_scaled.cwiseProduct(scaled);
  length.derivative[kEpsilon1] = whole.by_p * 0.5 * q1 * q1;
  length.derivative[kEpsilon2] = whole.by_a * across.by_p * 0.5 * q2 * q2;
  return length;
}

Vector3d deepest_point(const Superquadric& s, const Ray& ray) {
  const Vector3d origin = s.pose.linear().transpose() * (ray.origin - s.pose.translation());
  const Vector3d along = s.pose.linear().transpose() * ray.direction;
  // Exact for an ellipsoid; the gauge is convex, so its slope along the line changes sign once, near here.
  const Vector3d unit_origin = origin.cwiseQuotient(s.half_axes_m), unit_along = along.cwiseQuotient(s.half_axes_m);
  const double guess = -unit_origin.dot(unit_along) / unit_along.squaredNorm();
  double at = guess, width = 0.1 / unit_along.norm();
  const auto slope = [&](double t) { return slope_along(s, origin + t * along, along); };
  double low = at, high = at, slope_low = slope(at), slope_high = slope_low;
  while (slope_low > 0 && width < 1e3) slope_low = slope(low -= width), width *= 2;
  while (slope_high < 0 && width < 1e3) slope_high = slope(high += width), width *= 2;
  for (int k = 0; k < 8 && high - low > 2e-4; ++k) {  // 0.2 mm along the ray moves the distance by far less
    // Secant steps crawl where a sharp edge makes the slope jump: alternate them with halving.
    const double secant = low + (high - low) * slope_low / (slope_low - slope_high);
    at = k % 2 == 0 && slope_high > slope_low ? std::clamp(secant, low, high) : 0.5 * (low + high);
    const double here = slope(at);
    if (here < 0) low = at, slope_low = here;
    else high = at, slope_high = here;
  }
  return ray.origin + 0.5 * (low + high) * ray.direction;
}

}  // namespace gfp
