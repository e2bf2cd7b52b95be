#include "gfp/modelling/superquadric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "modelling/superquadric_norm.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// Gauge and its gradient at a point in body coordinates.
struct GaugeAt {
  double value;
  Vector3d gradient;
};

GaugeAt gauge_in_body(const Superquadric& s, const Vector3d& body) {
  const Vector3d unit = body.cwiseQuotient(s.half_axes_m);
  const NestedNorm norm = nested_norm(unit.x(), unit.y(), unit.z(), 2 / s.epsilon1, 2 / s.epsilon2);
  return {norm.value, Vector3d(norm.slope[0], norm.slope[1], norm.slope[2]).cwiseQuotient(s.half_axes_m)};
}

Vector3d to_body(const Superquadric& s, const Vector3d& point) {
  return s.pose.linear().transpose() * (point - s.pose.translation());
}

}  // namespace

double gauge(const Superquadric& superquadric, const Vector3d& point) {
  return gauge_in_body(superquadric, to_body(superquadric, point)).value;
}

double inside_outside(const Superquadric& superquadric, const Vector3d& point) {
  return std::pow(gauge(superquadric, point), 2 / superquadric.epsilon1);
}

double radial_distance(const Superquadric& superquadric, const Vector3d& point) {
  const Vector3d body = to_body(superquadric, point);
  const double value = gauge_in_body(superquadric, body).value;
  if (!(value > 0)) return -superquadric.half_axes_m.minCoeff();
  return body.norm() * (1 - 1 / value);
}

double surface_distance(const Superquadric& superquadric, const Vector3d& point) {
  const auto at = gauge_in_body(superquadric, to_body(superquadric, point));
  const double slope = at.gradient.norm();
  if (!(slope > 0)) return -superquadric.half_axes_m.minCoeff();
  return (at.value - 1) / slope;
}

double reach(const Superquadric& superquadric, const Vector3d& direction) {
  // The dual of a p-norm is the q-norm with 1/p + 1/q = 1, so the support function is two nested norms again.
  const Vector3d scaled = (superquadric.pose.linear().transpose() * direction).cwiseProduct(superquadric.half_axes_m).cwiseAbs();
  const auto dual = [](double a, double b, double epsilon) {
    const double p = 2 / epsilon;
    return p > 1 + 1e-9 ? p_norm(a, b, p / (p - 1)).value : std::max(a, b);
  };
  return dual(dual(scaled.x(), scaled.y(), superquadric.epsilon2), scaled.z(), superquadric.epsilon1);
}

double volume(const Superquadric& superquadric) {
  const double e1 = superquadric.epsilon1, e2 = superquadric.epsilon2;
  const auto beta = [](double a, double b) { return std::exp(std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b)); };
  return 2 * superquadric.half_axes_m.prod() * e1 * e2 * beta(e1 / 2 + 1, e1) * beta(e2 / 2, e2 / 2);
}

}  // namespace gfp
