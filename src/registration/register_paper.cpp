#include "gfp/registration/register_paper.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/mesh.hpp"
#include "gfp/memory/object_points.hpp"
#include "registration/align_icp.hpp"
#include "registration/nearest_point_field.hpp"

namespace gfp {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Angles about the object's x, y and z: R = Rx Ry Rz.
struct Turn {
  Vector3d angles;
  double cost;
};

Matrix3d rotation(const Vector3d& angles) {
  return (Eigen::AngleAxisd(angles.x(), Vector3d::UnitX()) * Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) * Eigen::AngleAxisd(angles.z(), Vector3d::UnitZ()))
      .toRotationMatrix();
}

Vector3d mean_of(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
}

std::vector<Vector3d> every_nth(const std::vector<Vector3d>& all, std::size_t wanted) {
  std::vector<Vector3d> some;
  const std::size_t step = std::max<std::size_t>(1, all.size() / wanted);
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

/// The sum of distances from the cluster's points to the primitive's nearest ones, both about their centres of mass.
class RotationSearch {
 public:
  RotationSearch(std::vector<Vector3d> cluster, const std::vector<Vector3d>& primitive, bool yaw_matters, const PaperRegistrationOptions& options)
      : cluster_(std::move(cluster)), coarse_(every_nth(cluster_, kCoarsePoints)), field_(primitive, 0.5 * bounds(primitive).size().maxCoeff()),
        yaw_matters_(yaw_matters), options_(options) {}

  Matrix3d run() const {
    std::vector<Turn> best = all_turns();
    double step = options_.rotation_step_rad;
    for (int halving = 0; halving < options_.halvings; ++halving) {
      step *= 0.5;
      best = around(best, step);
    }
    for (Turn& turn : best) turn.cost = cost(turn.angles, cluster_);
    keep(best, 1);
    return rotation(best.front().angles);
  }

 private:
  static constexpr std::size_t kCoarsePoints = 250;

  double cost(const Vector3d& angles, const std::vector<Vector3d>& points) const {
    const Matrix3d to_primitive = rotation(angles).transpose();
    double sum = 0;
    for (const auto& p : points) sum += field_.distance(to_primitive * p);
    return sum / static_cast<double>(points.size());
  }

  static void keep(std::vector<Turn>& turns, std::size_t count) {
    std::stable_sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) { return a.cost < b.cost; });
    if (turns.size() > count) turns.resize(count);
  }

  std::vector<Turn> all_turns() const {
    constexpr double kTurn = 2 * std::numbers::pi;
    const int steps = std::max(4, static_cast<int>(std::lround(kTurn / options_.rotation_step_rad)));
    const int half = steps / 2;
    std::vector<Turn> turns;
    for (int x = 0; x < steps; ++x)
      for (int y = 0; y <= half; ++y)  // pitch from -90 to 90 degrees: the rest are the same rotations again
        for (int z = 0; z < (yaw_matters_ ? steps : 1); ++z) {
          const Vector3d angles(x * kTurn / steps, (static_cast<double>(y) / half - 0.5) * std::numbers::pi, z * kTurn / steps);
          turns.push_back({angles, cost(angles, coarse_)});
        }
    keep(turns, static_cast<std::size_t>(options_.keep));
    return turns;
  }

  std::vector<Turn> around(const std::vector<Turn>& centres, double step) const {
    std::vector<Turn> turns(centres);
    for (const Turn& centre : centres)
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -1; z <= 1; ++z) {
            if ((x == 0 && y == 0 && z == 0) || (z != 0 && !yaw_matters_)) continue;
            const Vector3d angles = centre.angles + step * Vector3d(x, y, z);
            turns.push_back({angles, cost(angles, coarse_)});
          }
    keep(turns, static_cast<std::size_t>(options_.keep));
    return turns;
  }

  std::vector<Vector3d> cluster_, coarse_;
  NearestPointField field_;
  bool yaw_matters_;
  const PaperRegistrationOptions& options_;
};

/// The stable pose whose up direction is nearest to how the object came out.
int nearest_stable_pose(const Primitive& primitive, const Matrix3d& R_support_object) {
  int best = 0;
  double best_cosine = -2;
  for (std::size_t i = 0; i < primitive.stable_poses.size(); ++i) {
    const double cosine = primitive.stable_poses[i].R_support_object.row(2).dot(R_support_object.row(2));
    if (cosine > best_cosine + 1e-9) {
      best_cosine = cosine;
      best = static_cast<int>(i);
    }
  }
  return best;
}

}  // namespace

Placement register_paper(const ObjectView& view, const Hypothesis& hypothesis, const PaperRegistrationOptions& options) {
  const Primitive& primitive = *hypothesis.primitive;
  Placement placement;
  placement.primitive = hypothesis.primitive;
  placement.size_m = primitive.typical_size_m();
  std::vector<Vector3d> cluster;
  for (const auto& p : object_points(view)) cluster.push_back(p.cast<double>());
  const Vector3d cluster_centre = mean_of(cluster);
  placement.T_camera_object.linear() = view.T_camera_support.linear();
  placement.T_camera_object.translation() = cluster_centre;
  if (cluster.size() < 3) return placement;

  std::vector<Vector3d> points = shape(primitive, placement.size_m);
  const double radius = circumscribed_sphere(cluster).radius, scale = radius / circumscribed_sphere(points).radius;
  placement.size_m *= scale;
  for (auto& p : points) p *= scale;
  const Vector3d centre = mean_of(points);
  for (auto& p : points) p -= centre;
  for (auto& p : cluster) p -= cluster_centre;

  const Matrix3d R = RotationSearch(cluster, points, !primitive.symmetry.revolution, options).run();
  for (auto& p : points) p = R * p;
  const IcpResult icp = align_icp_pcl(cluster, points, options.icp_iterations);
  const Transform T_cluster_points = icp.T_target_source.inverse();

  // p' = s R (p - m_M) + m_C, and what ICP adds (P15).
  placement.T_camera_object = Eigen::Translation3d(cluster_centre) * T_cluster_points * Transform(R) * Eigen::Translation3d(-centre);
  placement.stable_pose = nearest_stable_pose(primitive, view.T_camera_support.linear().transpose() * placement.T_camera_object.linear());
  placement.cost = icp.mean_squared_m2 / std::max(1e-12, radius * radius);
  placement.iterations = options.icp_iterations;
  placement.converged = icp.converged;
  const double sigma2 = std::max(1e-8, icp.mean_squared_m2);
  placement.covariance = Eigen::MatrixXd::Zero(6, 6);
  placement.covariance.diagonal() << sigma2, sigma2, sigma2, sigma2 / (radius * radius), sigma2 / (radius * radius), sigma2 / (radius * radius);
  if (primitive.symmetry.revolution) {
    placement.yaw_low_rad = -std::numbers::pi;
    placement.yaw_high_rad = std::numbers::pi;
  }
  return placement;
}

}  // namespace gfp
