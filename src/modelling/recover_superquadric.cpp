#include "gfp/modelling/recover_superquadric.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "modelling/superquadric_em.hpp"
#include "modelling/superquadric_start.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMinPoints = 12;      ///< One more than there are parameters.
constexpr double kMinExtent = 0.001;        ///< Metres: the second largest extent of points that are not on a line.
constexpr std::size_t kSearchPoints = 200;
constexpr double kWorthSwitching = 0.5;     ///< Nats by which a look-alike must be better.

double weighted_rms(const SuperquadricData& problem, const EmFit& fit) {
  double squares = 0, total = 0;
  for (const auto& point : problem.points) {
    const double d = surface_distance(fit.superquadric, point);
    const double weight = std::exp(-0.5 * d * d / (fit.sigma_m * fit.sigma_m));
    squares += weight * d * d;
    total += weight;
  }
  return total > 0 ? std::sqrt(squares / total) : 0;
}

SuperquadricLimits limits_for(const Bounds& box) {
  SuperquadricLimits limits;
  limits.max_half_axis_m = std::max(0.01, 1.5 * box.size().norm());  // the hidden side is not larger than all that is seen
  return limits;
}

}  // namespace

std::vector<Vector3d> finite_points(std::span<const Vector3d> points) {
  std::vector<Vector3d> finite;
  finite.reserve(points.size());
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite), [](const Vector3d& p) { return p.allFinite(); });
  return finite;
}

Result<Superquadric> principal_axes_start(const std::vector<Vector3d>& points) {
  if (points.size() < kMinPoints)
    return failure(ErrorCode::kTooFewPoints, "finite points = " + std::to_string(points.size()) + ", expected at least 12");
  Vector3d mean = Vector3d::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const auto& p : points) moment += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moment);
  Superquadric start;
  // Smallest, middle, largest spread: z is the longest axis, the usual one of revolution.
  start.pose.linear() = axes.eigenvectors();
  if (start.pose.linear().determinant() < 0) start.pose.linear().col(0) *= -1;
  Vector3d low, high, size;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> along;
    for (const auto& p : points) along.push_back(start.pose.linear().col(k).dot(p));
    std::sort(along.begin(), along.end());
    size[k] = along.back() - along.front();
    low[k] = along[along.size() / 10];
    high[k] = along[along.size() - 1 - along.size() / 10];
  }
  if (!(size.y() > kMinExtent) || !size.allFinite())
    return failure(ErrorCode::kDegenerateGeometry, "second extent of the points = " + std::to_string(size.y()) + " m, expected above 0.001");
  start.pose.translation() = start.pose.linear() * Vector3d(0.5 * (low + high));
  // Between the shares of a box's and an ellipsoid's points that lie beyond; a seen plane needs some thickness to begin with.
  start.half_axes_m = (0.55 * (high - low)).cwiseMax(0.05 * size.maxCoeff());
  return start;
}

Result<SuperquadricFit> recover_superquadric_ems(std::span<const Vector3d> points, const RecoverSuperquadricOptions& options) {
  SuperquadricData problem;
  problem.points = finite_points(points);
  const auto start = principal_axes_start(problem.points);
  if (!start) return tl::unexpected(start.error());
  const Bounds box = bounds(problem.points);
  problem.sigma_m = options.noise_m;
  problem.range_m = 0.5 * box.size().norm();
  problem.limits = limits_for(box);
  // Where the surface is roughly, and which of its look-alikes it is, a few points tell; all of them polish it.
  const SuperquadricData coarse = thinned(problem, kSearchPoints);
  const EmOptions search{.max_iterations = options.max_iterations, .outlier_share = options.outlier_share};
  EmFit best = maximise(coarse, *start, {}, search);
  int iterations = best.iterations;
  for (bool switched = true; switched && iterations < 6 * options.max_iterations;) {
    switched = false;
    for (const auto& shape : similar_shapes(best.superquadric)) {
      const EmFit other = maximise(coarse, shape, {}, search);
      iterations += other.iterations;
      if (!(other.objective < best.objective - kWorthSwitching)) continue;
      best = other;
      switched = true;
      break;
    }
  }
  best = maximise(problem, best.superquadric, {}, search);
  iterations += best.iterations;
  return SuperquadricFit{best.superquadric, weighted_rms(problem, best), iterations, best.converged};
}

}  // namespace gfp
