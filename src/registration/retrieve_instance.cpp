#include "gfp/registration/retrieve_instance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"
#include "gfp/memory/object_points.hpp"
#include "registration/align_icp.hpp"
#include "registration/nearest_point_field.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSearchPoints = 250;  ///< Of the cluster, in the search; ICP takes all.

/// A member of a class: object frame, metres.
struct Instance {
  Vector3d size_m;
  std::vector<double> modes;
  TriangleMesh mesh;
};

/// The mean first, then members as the class spreads.
std::vector<Instance> members_of(const Primitive& primitive, const RetrieveInstanceOptions& options) {
  Random random(options.seed);
  const Eigen::Matrix3d spread = primitive.log_size_covariance.llt().matrixL();
  std::vector<Instance> members;
  for (int k = 0; k < options.instances; ++k) {
    Instance member{primitive.typical_size_m(), std::vector<double>(primitive.modes.size(), 0.0), {}};
    if (k > 0) {
      const Vector3d normal(random.normal(), random.normal(), random.normal());
      member.size_m = (primitive.log_size_mean + spread * normal).array().exp();
      for (double& mode : member.modes) mode = std::clamp(random.normal(), -2.0, 2.0);
    }
    member.mesh = {shape(primitive, member.size_m, member.modes), primitive.topology->triangles};
    members.push_back(std::move(member));
  }
  return members;
}

/// Points all over the surface: by its vertices alone, the member with the densest ones would win.
std::vector<Vector3d> spread_over(const TriangleMesh& mesh) {
  constexpr int kSteps = 4;
  std::vector<Vector3d> points;
  for (const Triangle& t : mesh.triangles) {
    const Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vector3d ab = mesh.vertices[static_cast<std::size_t>(t[1])] - a, ac = mesh.vertices[static_cast<std::size_t>(t[2])] - a;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; i + j < kSteps; ++j) points.push_back(a + (i + 1.0 / 3) / kSteps * ab + (j + 1.0 / 3) / kSteps * ac);
  }
  return points;
}

struct Found {
  double cost = std::numeric_limits<double>::infinity();
  const Hypothesis* hypothesis = nullptr;
  Instance member;
  Transform T_support_object = Transform::Identity();
  int stable_pose = 0;
};

/// The mean of the vertices that face the eye.
Vector3d seen_centre(const std::vector<Vector3d>& vertices, const std::vector<Vector3d>& normals, const Transform& T, const Vector3d& eye) {
  Vector3d sum = Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3d p = T * vertices[i];
    if ((T.linear() * normals[i]).dot(eye - p) <= 0) continue;
    sum += p;
    ++count;
  }
  return sum / std::max(1.0, count);
}

class Retrieval {
 public:
  Retrieval(const ObjectView& view, const RetrieveInstanceOptions& options) : options_(options) {
    const Transform T_support_camera = view.T_camera_support.inverse();
    eye_ = T_support_camera.translation();
    for (const auto& p : object_points(view)) cluster_.push_back(T_support_camera * p.cast<double>());
    for (const auto& p : cluster_) centre_ += p / static_cast<double>(cluster_.size());
  }
  std::size_t points() const { return cluster_.size(); }
  const std::vector<Vector3d>& cluster() const { return cluster_; }

  void try_member(const Hypothesis& hypothesis, const Instance& member, Found& best) const {
    const Primitive& primitive = *hypothesis.primitive;
    const NearestPointField field(spread_over(member.mesh), 0.5 * bounds(member.mesh.vertices).size().maxCoeff());
    const auto normals = vertex_normals(member.mesh);
    const std::vector<int> poses = hypothesis.stable_poses.empty() ? std::vector<int>{0} : hypothesis.stable_poses;
    const int yaws = primitive.symmetry.revolution ? 1 : options_.yaw_steps;
    for (const int pose : poses) {
      Transform rest = Transform::Identity();
      if (static_cast<std::size_t>(pose) < primitive.stable_poses.size()) rest.linear() = primitive.stable_poses[static_cast<std::size_t>(pose)].R_support_object;
      double low = std::numeric_limits<double>::infinity();
      for (const auto& v : member.mesh.vertices) low = std::min(low, (rest * v).z());
      for (int k = 0; k < (pose == 0 ? yaws : options_.yaw_steps); ++k) {
        Transform T = Eigen::Translation3d(centre_.x(), centre_.y(), -low) * Eigen::AngleAxisd(2 * std::numbers::pi * k / options_.yaw_steps, Vector3d::UnitZ()) * rest;
        const Vector3d shift = centre_ - seen_centre(member.mesh.vertices, normals, T, eye_);
        T.translation().head<2>() += shift.head<2>();
        const double cost = mean_distance(field, T);
        if (cost < best.cost) best = {cost, &hypothesis, member, T, pose};
      }
    }
  }

 private:
  double mean_distance(const NearestPointField& field, const Transform& T_support_object) const {
    const Transform T_object_support = T_support_object.inverse();
    const std::size_t step = std::max<std::size_t>(1, cluster_.size() / kSearchPoints);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < cluster_.size(); i += step, ++count) sum += field.distance(T_object_support * cluster_[i]);
    return sum / count;
  }

  const RetrieveInstanceOptions& options_;
  std::vector<Vector3d> cluster_;
  Vector3d centre_ = Vector3d::Zero(), eye_;
};

}  // namespace

Placement retrieve_instance(const ObjectView& view, const std::vector<Hypothesis>& hypotheses, const RetrieveInstanceOptions& options) {
  const Retrieval retrieval(view, options);
  if (retrieval.points() < 3) return {};
  Found best;
  for (const Hypothesis& hypothesis : hypotheses)
    for (const Instance& member : members_of(*hypothesis.primitive, options)) retrieval.try_member(hypothesis, member, best);
  if (best.hypothesis == nullptr) return {};

  std::vector<Vector3d> placed;
  for (const auto& v : best.member.mesh.vertices) placed.push_back(best.T_support_object * v);
  const IcpResult icp = align_icp(retrieval.cluster(), placed, options.icp_iterations);
  Placement placement;
  placement.primitive = best.hypothesis->primitive;
  placement.T_camera_object = view.T_camera_support * icp.T_target_source.inverse() * best.T_support_object;
  placement.size_m = best.member.size_m;
  placement.modes = std::move(best.member.modes);
  placement.stable_pose = best.stable_pose;
  placement.cost = icp.mean_squared_m2;
  placement.iterations = options.icp_iterations;
  placement.converged = icp.converged;
  if (placement.primitive->symmetry.revolution) {
    placement.yaw_low_rad = -std::numbers::pi;
    placement.yaw_high_rad = std::numbers::pi;
  }
  return placement;
}

}  // namespace gfp
