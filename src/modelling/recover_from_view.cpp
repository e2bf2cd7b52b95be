#include "modelling/recover_from_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "modelling/superquadric_em.hpp"

namespace gfp {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSearchPoints = 150, kSearchTangents = 30, kSearchIterations = 10;
constexpr double kWorthFreedom = 8.0;    ///< Nats by which a freer body (not round, leaning) must explain more.
constexpr double kSharpExponent = 0.1;

/// Smallest upright box about the points' shadows: yaw of its first side, half sides, centre.
struct Footprint {
  double yaw = 0;
  Vector2d half_sides = Vector2d::Zero(), centre = Vector2d::Zero();
};

Footprint smallest_footprint(const std::vector<Vector3d>& points) {
  Footprint best;
  double best_area = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 18; ++step) {
    const double yaw = step * std::numbers::pi / 36;
    const Eigen::Rotation2Dd turn(yaw);
    Vector2d low = Vector2d::Constant(1e300), high = -low;
    for (const auto& p : points) {
      const Vector2d q = turn.inverse() * p.head<2>();
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    const double area = (high - low).prod();
    if (!(area < best_area)) continue;
    best_area = area;
    best = {yaw, 0.5 * (high - low), turn * (0.5 * (low + high))};
  }
  return best;
}

/// Upright starts: z up, or lying along the longer and the shorter side.
std::vector<Superquadric> upright_starts(const Superquadric& box) {
  Superquadric standing = box;
  standing.epsilon1 = standing.epsilon2 = 0.6;
  std::vector<Superquadric> starts{standing};
  Eigen::Matrix3d lie;
  lie.col(0) = Vector3d::UnitZ();
  lie.col(1) = Vector3d::UnitX();
  lie.col(2) = Vector3d::UnitY();
  Superquadric lying = standing;  // body z along the box's y
  lying.pose.linear() = standing.pose.linear() * lie;
  lying.half_axes_m = Vector3d(standing.half_axes_m.z(), standing.half_axes_m.x(), standing.half_axes_m.y());
  starts.push_back(lying);
  Superquadric across = standing;  // body z along the box's x
  across.pose.linear() = standing.pose.linear() * lie.transpose();
  across.half_axes_m = Vector3d(standing.half_axes_m.y(), standing.half_axes_m.z(), standing.half_axes_m.x());
  starts.push_back(across);
  return starts;
}

SuperquadricData em_data(const SeenSurface& seen, bool on_support) {
  SuperquadricData problem;
  problem.points = seen.outer_points;
  problem.tangents = seen.tangents;
  const Vector3d size = bounds(problem.points).size();
  problem.sigma_m = std::hypot(seen.sigma_m, kModelError);
  problem.tangent_sigma_m = std::hypot(0.5 * seen.pixel_m, kModelError);
  problem.range_m = 0.5 * size.norm();
  problem.on_base = on_support;
  problem.limits.max_half_axis_m = std::max(0.01, 0.7 * size.norm());
  problem.limits.min_half_axis_m = 0.002;
  return problem;
}

/// A solid of revolution about the body's z axis.
Superquadric rounded(Superquadric s) {
  s.half_axes_m.x() = s.half_axes_m.y() = std::max(s.half_axes_m.x(), s.half_axes_m.y());
  s.epsilon2 = 1;
  return s;
}

}  // namespace

Superquadric box_about(const std::vector<Vector3d>& points, bool on_support) {
  Superquadric box;
  box.epsilon1 = box.epsilon2 = kSharpExponent;
  const Footprint footprint = smallest_footprint(points);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& p : points) low = std::min(low, p.z()), high = std::max(high, p.z());
  if (on_support) low = 0;
  box.half_axes_m = Vector3d(footprint.half_sides.x(), footprint.half_sides.y(), 0.5 * (high - low)).cwiseMax(0.005);
  box.pose.linear() = Eigen::AngleAxisd(footprint.yaw, Vector3d::UnitZ()).toRotationMatrix();
  box.pose.translation() << footprint.centre, (on_support ? box.half_axes_m.z() : 0.5 * (low + high));
  return box;
}

bool tells_a_shape(const SeenSurface& seen) { return seen.outer_points.size() >= 12 && bounds(seen.points).size().norm() > 0.004; }

SeenSuperquadric recover_from_view(const SeenSurface& seen, bool on_support, int max_iterations) {
  using Freedom = SuperquadricFreedom;
  const Freedom upright{.rotation = Freedom::Rotation::kAboutVertical};
  const Freedom round{.rotation = Freedom::Rotation::kAboutVertical, .axes = Freedom::Axes::kRound, .epsilon2 = false};
  const SuperquadricData fine = em_data(seen, on_support), coarse = thinned(fine, kSearchPoints, kSearchTangents);
  const EmOptions search{.max_iterations = kSearchIterations};
  std::optional<EmFit> best, best_round;
  for (const auto& start : upright_starts(box_about(seen.points, on_support))) {
    EmFit fit = maximise(coarse, start, upright, search);
    if (!best || fit.objective < best->objective) best = fit;
    fit = maximise(coarse, rounded(start), round, search);
    if (!best_round || fit.objective < best_round->objective) best_round = fit;
  }
  for (const auto& shape : similar_shapes(best->superquadric)) {
    EmFit fit = maximise(coarse, shape, upright, search);
    if (fit.objective < best->objective - 1) best = fit;
  }
  const EmOptions last{.max_iterations = max_iterations};
  EmFit fit = maximise(fine, best_round->superquadric, round, last);
  for (const auto& [start, freedom] : {std::pair(best->superquadric, upright), {best->superquadric, Freedom{}}}) {
    const EmFit freer = maximise(fine, start, freedom, last);
    if (freer.objective < fit.objective - kWorthFreedom) fit = freer;
  }
  // Rotations of EM are about the body's axes; the support's take their place.
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Identity();
  turn.bottomRightCorner<3, 3>() = fit.superquadric.pose.linear().transpose();
  return {fit.superquadric, fit.sigma_m, fit.iterations, fit.converged, turn.transpose() * fit.information.topLeftCorner<6, 6>() * turn};
}

bool is_plausible(const Superquadric& s, const Superquadric& box) {
  if (!s.pose.matrix().allFinite() || !s.half_axes_m.allFinite()) return false;
  const double seen_radius = box.half_axes_m.norm();
  return s.half_axes_m.norm() < 2.5 * seen_radius && (s.pose.translation() - box.pose.translation()).norm() < 2 * seen_radius;
}

Vector3d horizontal_axis(const Superquadric& s) {
  const Vector3d x = s.pose.linear().col(0), z = s.pose.linear().col(2);
  return std::abs(z.z()) < 0.5 ? z : x;
}

}  // namespace gfp
