#include "grasp/shape_uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "gfp/core/random.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kLeastCorrelationLength = 0.030;  // metres over which a shape error keeps its sign; on large things, their radius
constexpr double kFrictionSpread = 0.2;
constexpr double kMostTilt = 0.7;             // radians: a tilt is a small error, not another shape

/// S with S S^T = covariance; negative eigenvalues (rounding) count as zero.
Matrix6d square_root(const Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

std::vector<ShapeDraw> draw_shapes(const FittedModel& model, int count, std::uint64_t seed) {
  Random random(seed);
  const bool pose_known = model.pose_covariance.isZero();
  const Matrix6d spread = pose_known ? Matrix6d::Zero() : square_root(model.pose_covariance);
  std::vector<ShapeDraw> draws(static_cast<std::size_t>(count));
  for (ShapeDraw& draw : draws) {
    Vector6d unit;
    for (double& x : unit) x = random.normal();
    if (!pose_known) {
      const Vector6d motion = spread * unit;
      Transform moved = Transform::Identity();  // tangent at the right: T_camera_object * moved
      moved.linear() = rotation_from_vector(motion.tail<3>());
      moved.translation() = motion.head<3>();
      draw.T_fit_true = model.T_camera_object * moved.inverse() * model.T_camera_object.inverse();
    }
    draw.offset = {random.normal(), random.normal()};
    for (Eigen::Vector2d& slope : draw.slope) slope = {random.normal(), random.normal()};
    draw.friction_factor = std::exp(kFrictionSpread * random.normal());
  }
  return draws;
}

ClosureStatistics closure_statistics(const JawLine& jaw, const std::vector<ShapeDraw>& draws, const TriangleBvh& bvh,
                                     const std::vector<Vector3d>& normals_camera, const std::vector<float>& triangle_sigma_m,
                                     double friction, double torsion_m, const WrenchScale& scale, double min_epsilon) {
  const double correlation_m = std::max(kLeastCorrelationLength, scale.radius_m);
  std::vector<double> epsilons;
  std::vector<Crossing> crossings;
  for (const ShapeDraw& draw : draws) {
    std::array<WrenchContact, 2> contacts;
    bool touched = true;
    double travel_m = 0;  // of both pads together: past the opening, nothing is left between them
    for (std::size_t i = 0; i < 2 && touched; ++i) {
      const double side = i == 0 ? 1 : -1;
      const Vector3d start = draw.T_fit_true * (jaw.centre + 0.5 * side * jaw.opening_m * jaw.axis);
      const Vector3d along = draw.T_fit_true.linear() * (-side * jaw.axis);
      bvh.crossings(start, along, jaw.opening_m, crossings);
      touched = !crossings.empty() && crossings.front().entering;
      if (!touched) break;
      const auto triangle = static_cast<std::size_t>(crossings.front().triangle);
      const double sigma = triangle_sigma_m[triangle], outwards = draw.offset[static_cast<Eigen::Index>(i)] * sigma;
      const Vector3d normal = normals_camera[triangle];
      const double until_touch_m = crossings.front().distance_m - outwards;
      travel_m += until_touch_m;
      touched = until_touch_m > 0 && travel_m < jaw.opening_m;  // false for a sigma that is no number
      const auto [t1, t2] = orthonormal_basis(normal);
      const Eigen::Vector2d tilt = (sigma / correlation_m * draw.slope[i]).cwiseMax(-kMostTilt).cwiseMin(kMostTilt);
      contacts[i] = {start + crossings.front().distance_m * along + outwards * normal,
                     -(normal + tilt.x() * t1 + tilt.y() * t2).normalized(), friction * draw.friction_factor, torsion_m};
    }
    epsilons.push_back(touched ? grasp_quality(contacts, scale).epsilon : 0);
  }
  if (epsilons.empty()) return {};
  std::sort(epsilons.begin(), epsilons.end());
  const auto closed = epsilons.end() - std::lower_bound(epsilons.begin(), epsilons.end(), std::max(min_epsilon, 1e-12));
  return {static_cast<double>(closed) / static_cast<double>(epsilons.size()), epsilons[epsilons.size() / 10]};
}

}  // namespace gfp
