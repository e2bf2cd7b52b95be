#include "modelling/vertex_sigma.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "gfp/core/mesh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kBiasM = 0.0003;         ///< Of seen vertices, calibrated on coverage like the others; the gap that the contour left to the data is added.
constexpr double kUnseenBiasM = 0.0012;   ///< Of inferred ones: what neither noise nor modes explain.
constexpr double kIndependentReadings = 20;
constexpr double kPosteriorInflation = 1.8;  ///< Real shapes leave their class's modes: calibrated on coverage, as reported by gfp eval.
constexpr double kCarryLengthM = 0.03;    ///< Over this distance from seen surface the local shape is forgotten.

/// Distance along edges from every vertex to the nearest observed one (Dijkstra), metres; large where nothing is observed.
std::vector<double> distance_to_observed(const TriangleMesh& mesh, const std::vector<std::uint8_t>& states) {
  const VertexAdjacency adjacency = vertex_adjacency(mesh);
  std::vector<double> distance(mesh.vertices.size(), 1.0);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!(states[i] & kVertexObserved)) continue;
    distance[i] = 0;
    queue.emplace(0.0, i);
  }
  while (!queue.empty()) {
    const auto [reached, i] = queue.top();
    queue.pop();
    if (reached > distance[i]) continue;
    for (auto k = adjacency.offsets[i]; k < adjacency.offsets[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(adjacency.indices[static_cast<std::size_t>(k)]);
      const double next = reached + (mesh.vertices[i] - mesh.vertices[j]).norm();
      if (next >= distance[j]) continue;
      distance[j] = next;
      queue.emplace(next, j);
    }
  }
  return distance;
}

/// Variance of the vertex along its normal under the placement's posterior: j^T C j with j as in registration's tangent order.
double posterior_variance(const Placement& placement, const Transform& T_support_object, std::size_t vertex, const Vector3d& point, const Vector3d& normal) {
  if (placement.covariance.rows() < 9) return 0;
  const Primitive& primitive = *placement.primitive;
  Eigen::VectorXd j(placement.covariance.rows());
  const Vector3d direction = placement.size_m.cwiseProduct(T_support_object.linear().transpose() * normal);
  Vector3d canonical = primitive.mean[vertex];
  for (std::size_t k = 0; k < placement.modes.size(); ++k) canonical += placement.modes[k] * primitive.modes[k][vertex];
  j.segment<3>(0) = normal;
  j.segment<3>(3) = (point - T_support_object.translation()).cross(normal);
  j.segment<3>(6) = direction.cwiseProduct(canonical);
  for (Eigen::Index k = 9; k < j.size(); ++k) j[k] = direction.dot(primitive.modes[static_cast<std::size_t>(k - 9)][vertex]);
  return j.dot(placement.covariance * j);
}

}  // namespace

std::vector<float> vertex_sigma(const ObjectView& view, const Placement& placement, const SurfaceTargets& data, const std::vector<std::uint8_t>& states,
                                const std::vector<Vector3d>& vertices, const std::vector<Vector3d>& normals) {
  const Transform T_support_object = view.T_camera_support.inverse() * placement.T_camera_object;
  const auto distance = distance_to_observed({vertices, placement.primitive->topology->triangles}, states);
  const double residual_m = placement.primitive->residual_sigma * placement.size_m.mean();
  std::vector<float> sigma(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double noise = view.noise.sigma_m((view.T_camera_support * vertices[i]).z());
    if (states[i] & kVertexObserved) {
      const double readings = std::clamp(data.readings[i], 1.0, kIndependentReadings);
      sigma[i] = static_cast<float>(std::sqrt(noise * noise / readings + kBiasM * kBiasM + data.distance_m[i] * data.distance_m[i]));
      continue;
    }
    const double forgotten = 1.0 - std::exp(-distance[i] / kCarryLengthM);
    const double local = std::hypot(kUnseenBiasM, residual_m * forgotten);
    sigma[i] = static_cast<float>(std::sqrt(kPosteriorInflation * posterior_variance(placement, T_support_object, i, vertices[i], normals[i]) + local * local));
  }
  return sigma;
}

}  // namespace gfp
