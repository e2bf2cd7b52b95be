#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "gfp/core/mesh.hpp"
#include "gfp/modelling/recover_superquadric.hpp"
#include "modelling/superquadric_residual.hpp"
#include "modelling/superquadric_start.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Information = Eigen::Matrix<double, kSuperquadricParameters, kSuperquadricParameters>;

struct Residuals {
  Information hessian = Information::Zero();
  SuperquadricStep gradient = SuperquadricStep::Zero();
  double cost = 0;
};

/// r = sqrt(a1 a2 a3) (F^e1 - 1). In terms of the gauge F^e1 = gauge^2, which does not overflow.
Residuals solina_residuals(const std::vector<Vector3d>& points, const Superquadric& s) {
  const double factor = std::sqrt(s.half_axes_m.prod());
  Residuals sum;
  for (const LinearisedGauge& at : linearised_gauges(s, points)) {
    const double residual = factor * (at.value * at.value - 1);
    SuperquadricStep derivative = factor * 2 * at.value * at.derivative;
    for (int k = 0; k < 3; ++k) derivative[kLogAxes + k] += 0.5 * residual;  // of the volume factor
    sum.hessian += derivative * derivative.transpose();
    sum.gradient += derivative * residual;
    sum.cost += residual * residual;
  }
  return sum;
}

}  // namespace

Result<SuperquadricFit> recover_superquadric_lm(std::span<const Vector3d> points, const RecoverSuperquadricOptions& options) {
  const auto finite = finite_points(points);
  const auto start = principal_axes_start(finite);
  if (!start) return tl::unexpected(start.error());
  SuperquadricLimits limits;
  limits.max_half_axis_m = std::max(0.01, 1.5 * bounds(finite).size().norm());
  SuperquadricFit fit;
  fit.superquadric = *start;
  Residuals at = solina_residuals(finite, fit.superquadric);
  double damping = 1e-2;
  for (; fit.iterations < options.max_iterations && !fit.converged; ++fit.iterations) {
    Information damped = at.hessian;
    damped.diagonal() += damping * (at.hessian.diagonal().array() + 1e-12).matrix();
    const SuperquadricStep step = -damped.ldlt().solve(at.gradient);
    const Superquadric trial = stepped(fit.superquadric, step, limits);
    const Residuals there = solina_residuals(finite, trial);
    if (!(there.cost < at.cost)) {
      fit.converged = damping > 1e6;
      damping *= 10;
      continue;
    }
    fit.converged = at.cost - there.cost < 1e-6 * at.cost;
    damping = std::max(1e-9, damping / 10);
    fit.superquadric = trial;
    at = there;
  }
  double squares = 0;
  for (const auto& point : finite) squares += std::pow(surface_distance(fit.superquadric, point), 2);
  fit.rms_m = std::sqrt(squares / static_cast<double>(finite.size()));
  return fit;
}

}  // namespace gfp
