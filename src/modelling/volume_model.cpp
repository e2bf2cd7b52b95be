#include "modelling/volume_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gfp/modelling/evaluate_fit.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kInferredGrowth = 0.25;  ///< Metres of 1-sigma per metre from the nearest seen vertex.
constexpr double kInferredBase = 0.003;   ///< Metres: what a guess errs by even beside a seen vertex.

/// Marks vertices that face the camera and lie on the object's readings.
void mark_seen(const ObjectView& view, const TriangleMesh& mesh_camera, std::vector<std::uint8_t>& states) {
  const auto normals = vertex_normals(mesh_camera);
  states.assign(mesh_camera.vertices.size(), 0);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const Vector3d& p = mesh_camera.vertices[k];
    if (!(p.z() > 0) || normals[k].dot(p) >= 0) continue;
    const Eigen::Vector2d pixel = view.camera.project(p);
    const int i = static_cast<int>(std::lround(pixel.x())) - view.tile.u0, j = static_cast<int>(std::lround(pixel.y())) - view.tile.v0;
    if (!view.evidence.contains(i, j) || view.evidence.at(i, j) != Evidence::kObject) continue;
    const double z = view.depth_m.at(i, j);
    if (std::abs(z - p.z()) < 3 * view.noise.sigma_m(z) + 0.003) states[k] = kVertexObserved;
  }
}

/// Seen: noise and the body's own misfit. Else it grows with the distance to the nearest seen vertex.
std::vector<float> sigma_of(const std::vector<Vector3d>& vertices, const std::vector<std::uint8_t>& states, double surface_sigma_m) {
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
  model.vertices.reserve(body.vertices_support.size());
  for (const auto& v : body.vertices_support) model.vertices.push_back(T_object_support * v);
  model.T_camera_object = view.T_camera_support * Eigen::Translation3d(0, 0, lift) * T_support_object;
  model.size_m = bounds(model.vertices).size();
  mark_seen(view, model.mesh_camera(), model.states);
  model.sigma_m = sigma_of(model.vertices, model.states, body.surface_sigma_m);
  model.yaw_low_rad = model.yaw_high_rad = 0;
  model.evidence = evaluate_fit(view, model.mesh_camera().vertices, model.topology->triangles);
  return model;
}

}  // namespace gfp
