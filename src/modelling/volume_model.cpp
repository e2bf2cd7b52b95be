#include "modelling/volume_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "gfp/modelling/evaluate_fit.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kInferredGrowth = 0.25;  ///< Metres of 1-sigma per metre from the nearest seen vertex.
constexpr double kInferredBase = 0.003;   ///< Metres: what a guess errs by even beside a seen vertex.

}  // namespace

std::vector<float> sigma_by_distance(const std::vector<Vector3d>& vertices, const std::vector<std::uint8_t>& states, double surface_sigma_m) {
  std::vector<Vector3d> seen;
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (states[k] & kVertexObserved) seen.push_back(vertices[k]);
  const double diagonal = bounds(vertices).size().norm();
  std::vector<float> sigma(vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (states[k] & kVertexObserved) {
      sigma[k] = static_cast<float>(surface_sigma_m);
      continue;
    }
    double nearest = diagonal * diagonal;
    for (const auto& s : seen) nearest = std::min(nearest, (s - vertices[k]).squaredNorm());
    sigma[k] = static_cast<float>(std::hypot(surface_sigma_m, kInferredBase + kInferredGrowth * std::sqrt(nearest)));
  }
  return sigma;
}

namespace {

/// Covariance of x y z rx ry rz in the object frame. What the data leave open is held by priors of 50 mm and 1 rad.
Eigen::Matrix<double, 6, 6> pose_covariance(const SupportedBody& body, const Transform& T_support_object) {
  Eigen::Matrix<double, 6, 6> information = body.pose_information;
  information.diagonal().head<3>().array() += 1 / (0.05 * 0.05);
  information.diagonal().tail<3>().array() += 1.0;
  const Eigen::Matrix3d R_object_support = T_support_object.linear().transpose();
  // A turn about the centre also moves the base, where the object's origin is.
  const Vector3d arm = T_support_object.translation() - body.centre_support;
  Eigen::Matrix3d moves;
  moves << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  Eigen::Matrix<double, 6, 6> to_object = Eigen::Matrix<double, 6, 6>::Zero();
  to_object.topLeftCorner<3, 3>() = R_object_support;
  to_object.topRightCorner<3, 3>() = R_object_support * moves;
  to_object.bottomRightCorner<3, 3>() = R_object_support;
  const Eigen::Matrix<double, 6, 6> covariance = information.ldlt().solve(Eigen::Matrix<double, 6, 6>::Identity());
  return to_object * covariance * to_object.transpose();
}

}  // namespace

FittedModel volume_model(const ObjectView& view, const SupportedBody& body) {
  const Bounds box = bounds(body.vertices_support);
  const Vector3d base(box.centre().x(), box.centre().y(), box.low.z());
  const double lift = view.has_support ? std::max(0.0, -base.z()) : 0.0;
  const double yaw = std::atan2(body.axis_support.y(), body.axis_support.x());
  Transform T_support_object(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
  T_support_object.translation() = base;
  const Transform T_object_support = T_support_object.inverse();

  FittedModel model;
  model.method = body.method;
  model.class_name = "unknown";
  model.topology = body.topology;
  model.vertices = transformed(body.vertices_support, T_object_support);
  model.T_camera_object = view.T_camera_support * Eigen::Translation3d(0, 0, lift) * T_support_object;
  model.size_m = bounds(model.vertices).size();
  const auto vertices_camera = model.vertices_camera();
  model.evidence = evaluate_fit(view, vertices_camera, model.topology->triangles, model.states);
  model.sigma_m = sigma_by_distance(model.vertices, model.states, body.surface_sigma_m);
  model.pose_covariance = pose_covariance(body, T_support_object);
  return model;
}

}  // namespace gfp
