#include "gfp/modelling/fit_simple_primitive.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gfp/core/convex_hull.hpp"
#include "gfp/modelling/superquadric.hpp"
#include "modelling/volume_model.hpp"

namespace gfp {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSharp = 0.01, kRound = 1.0;                 ///< Exponents of edges and of curves.
constexpr double kLeastM = 0.003, kGreatestM = 0.5;           ///< Half axes.
constexpr double kLevelNormal = 0.4;                          ///< |n . up| below this: the side of a cylinder.
constexpr std::size_t kLeastPoints = 12;
constexpr double kPlaceSigmaM = 0.003, kTurnSigmaRad = 0.1;   ///< What is claimed of the pose: closed-form fits have no posterior.

/// The object's readings in the support frame; normals are zero where there are none.
struct Seen {
  std::vector<Vector3d> points, normals;
  double height_m = 0;
};

Seen collect(const ObjectView& view) {
  const Transform T_support_camera = view.T_camera_support.inverse();
  Seen seen;
  std::vector<double> heights;
  for (int j = 0; j < view.depth_m.height; ++j)
    for (int i = 0; i < view.depth_m.width; ++i) {
      const double z = view.depth_m.at(i, j);
      if (view.evidence.at(i, j) != Evidence::kObject || !(z > 0) || !std::isfinite(z)) continue;
      seen.points.push_back(T_support_camera * (view.camera.ray(view.tile.u0 + i, view.tile.v0 + j) * z));
      seen.normals.push_back(T_support_camera.linear() * view.normals.at(i, j).cast<double>());
      heights.push_back(seen.points.back().z());
    }
  if (heights.empty()) return seen;
  const auto high = heights.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(heights.size() - 1));
  std::nth_element(heights.begin(), high, heights.end());
  seen.height_m = std::max(2 * kLeastM, *high);
  return seen;
}

double half_axis(double value) { return std::clamp(value, kLeastM, kGreatestM); }

Superquadric upright(const Vector3d& centre, const Vector3d& half_axes, double yaw, double epsilon1, double epsilon2) {
  Superquadric body{half_axes.unaryExpr(&half_axis), epsilon1, epsilon2, Transform::Identity()};
  body.pose = Eigen::Translation3d(centre) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ());
  return body;
}

/// The smallest rectangle has a side along an edge of the convex hull.
Superquadric box_around(const Seen& seen) {
  std::vector<Vector2d> flat;
  for (const auto& p : seen.points) flat.push_back(p.head<2>());
  const auto hull = convex_hull(std::move(flat));
  double least = std::numeric_limits<double>::infinity();
  Superquadric best = upright({hull.front().x(), hull.front().y(), 0.5 * seen.height_m}, Vector3d::Constant(kLeastM), 0, kSharp, kSharp);
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vector2d edge = hull[(k + 1) % hull.size()] - hull[k];
    if (edge.norm() < 1e-9) continue;
    const double yaw = std::atan2(edge.y(), edge.x());
    const Eigen::Rotation2Dd turn(yaw);
    Vector2d low = Vector2d::Constant(1e9), high = -low;
    for (const auto& corner : hull) {
      const Vector2d p = turn.inverse() * corner;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double area = (high - low).prod();
    if (area >= least) continue;
    least = area;
    const Vector2d centre = turn * Vector2d(0.5 * (low + high)), half = 0.5 * (high - low);
    best = upright({centre.x(), centre.y(), 0.5 * seen.height_m}, {half.x(), half.y(), 0.5 * seen.height_m}, yaw, kSharp, kSharp);
  }
  return best;
}

/// Kasa's algebraic fit: 2 c . p + (r^2 - |c|^2) = |p|^2, linear in its unknowns; about the points' mean.
template <int kDimensions>
std::optional<std::pair<Eigen::Matrix<double, kDimensions, 1>, double>> fit_round(const std::vector<Eigen::Matrix<double, kDimensions, 1>>& points) {
  using Point = Eigen::Matrix<double, kDimensions, 1>;
  if (points.size() < kLeastPoints) return std::nullopt;
  Point mean = Point::Zero();
  for (const auto& p : points) mean += p / static_cast<double>(points.size());
  Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), kDimensions + 1);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Point p = points[static_cast<std::size_t>(i)] - mean;
    a.row(i) << 2 * p.transpose(), 1;
    b[i] = p.squaredNorm();
  }
  const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
  const Point centre = x.template head<kDimensions>();
  const double squared = x[kDimensions] + centre.squaredNorm();
  if (!x.allFinite() || !(squared > 0)) return std::nullopt;
  return std::pair<Point, double>(centre + mean, std::sqrt(squared));
}

std::optional<Superquadric> cylinder_through(const Seen& seen) {
  std::vector<Vector2d> side;
  for (std::size_t i = 0; i < seen.points.size(); ++i)
    if (seen.normals[i].squaredNorm() > 0.5 && std::abs(seen.normals[i].z()) < kLevelNormal) side.push_back(seen.points[i].head<2>());
  const auto circle = fit_round<2>(side);
  if (!circle) return std::nullopt;
  return upright({circle->first.x(), circle->first.y(), 0.5 * seen.height_m}, {circle->second, circle->second, 0.5 * seen.height_m}, 0, kSharp, kRound);
}

std::optional<Superquadric> sphere_through(const Seen& seen) {
  const auto sphere = fit_round<3>(seen.points);
  if (!sphere) return std::nullopt;
  return upright(sphere->first, Vector3d::Constant(sphere->second), 0, kRound, kRound);
}

}  // namespace

FittedModel fit_simple_primitive(const ObjectView& view) {
  const Seen seen = collect(view);
  std::vector<Superquadric> bodies;
  if (seen.points.empty()) {
    bodies.push_back(upright(view.T_camera_support.inverse() * Vector3d(0, 0, 1), Vector3d::Constant(0.01), 0, kSharp, kSharp));
  } else {
    bodies.push_back(box_around(seen));
    for (const auto& body : {cylinder_through(seen), sphere_through(seen)})
      if (body) bodies.push_back(*body);
  }
  std::optional<FittedModel> best;
  for (const Superquadric& body : bodies) {
    const double surface_sigma_m = std::max(0.001, view.noise.sigma_m(view.T_camera_support.translation().z()));
    SupportedBody supported{"simple_primitive", superquadric_topology(), superquadric_vertices(body), body.pose.linear().col(0), surface_sigma_m,
                            Eigen::Matrix<double, 6, 6>::Zero(), body.pose.translation()};
    supported.pose_information.diagonal() << Vector3d::Constant(1 / (kPlaceSigmaM * kPlaceSigmaM)), Vector3d::Constant(1 / (kTurnSigmaRad * kTurnSigmaRad));
    FittedModel model = volume_model(view, supported);
    if (!best || model.evidence.cost < best->evidence.cost) best = std::move(model);
  }
  best->converged = bodies.size() > 1;
  return *best;
}

}  // namespace gfp
