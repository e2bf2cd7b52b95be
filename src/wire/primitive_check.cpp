#include "wire/primitive_check.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "gfp/primitive/content_hash.hpp"

namespace gfp::wire {
namespace {

using Outcome = Result<void>;

Outcome corrupt(const std::string& what) { return failure(ErrorCode::kCorruptData, what); }

bool all_finite(const std::vector<Eigen::Vector3d>& points) {
  for (const auto& p : points)
    if (!p.allFinite()) return false;
  return true;
}

Outcome check_surface(const Primitive& primitive, const std::vector<Triangle>& triangles, const char* what, bool genus_known) {
  const MeshTopology topology = examine_topology({primitive.mean, triangles});
  if (!topology.closed) return corrupt(fmt::format("{} are no closed, oriented surface", what));
  if (genus_known && topology.euler_characteristic != 2 * topology.components - 2 * primitive.genus)
    return corrupt(fmt::format("Euler characteristic = {}, expected {} for genus {}", topology.euler_characteristic, 2 * topology.components - 2 * primitive.genus, primitive.genus));
  return {};
}

Outcome check_shape(const Primitive& primitive) {
  if (primitive.name.empty()) return corrupt("name is empty");
  if (primitive.class_name.empty()) return corrupt("class_name is empty");
  if (!all_finite(primitive.mean)) return corrupt("mean is not finite");
  for (std::size_t k = 0; k < primitive.modes.size(); ++k) {
    if (primitive.modes[k].size() != primitive.size()) return corrupt(fmt::format("mode {} has {} vertices, expected {}", k, primitive.modes[k].size(), primitive.size()));
    if (!all_finite(primitive.modes[k]) || !std::isfinite(primitive.mode_sigma[k])) return corrupt(fmt::format("mode {} is not finite", k));
  }
  if (primitive.topology->types.size() != primitive.size() || primitive.topology->parts.size() != primitive.size()) return corrupt("types or parts are missing");
  if (auto closed = check_surface(primitive, primitive.topology->triangles, "triangles", true); !closed) return closed;
  return check_surface(primitive, primitive.topology->filled_triangles, "filled_triangles", false);
}

Outcome check_numbers(const Primitive& primitive) {
  if (!primitive.log_size_mean.allFinite() || primitive.log_size_mean.cwiseAbs().maxCoeff() > 10) return corrupt("log_size_mean is beyond [-10, 10]");
  const Eigen::Matrix3d& covariance = primitive.log_size_covariance;
  if (!covariance.allFinite() || !covariance.isApprox(covariance.transpose(), 1e-9) || covariance.llt().info() != Eigen::Success)
    return corrupt("log_size_covariance is not symmetric and positive definite");
  if (!(primitive.residual_sigma >= 0 && primitive.residual_sigma < 10)) return corrupt(fmt::format("residual_sigma = {}, expected [0, 10)", primitive.residual_sigma));
  if (!(primitive.rest_edge_length > 0 && primitive.rest_edge_length < 1e3)) return corrupt(fmt::format("rest_edge_length = {}, expected (0, 1000)", primitive.rest_edge_length));
  if (primitive.symmetry.cyclic < 1) return corrupt(fmt::format("symmetry.cyclic = {}, expected at least 1", primitive.symmetry.cyclic));
  return {};
}

Outcome check_poses(const Primitive& primitive) {
  if (primitive.stable_poses.empty()) return corrupt("stable_poses is empty");
  for (const auto& pose : primitive.stable_poses) {
    const Eigen::Matrix3d& R = pose.R_support_object;
    if (!R.allFinite() || !(R * R.transpose()).isIdentity(1e-6) || R.determinant() < 0) return corrupt("stable pose '" + pose.name + "' is no rotation");
    if (!(pose.probability >= 0 && pose.probability <= 1)) return corrupt(fmt::format("probability of '{}' = {}, expected [0, 1]", pose.name, pose.probability));
  }
  return {};
}

Outcome check_contacts(const Primitive& primitive) {
  const auto faces = static_cast<std::int32_t>(primitive.topology->triangles.size());
  for (const auto& pair : primitive.contact_pairs) {
    for (int side = 0; side < 2; ++side) {
      if (pair.face[side] < 0 || pair.face[side] >= faces) return corrupt(fmt::format("contact on triangle {}, expected [0, {})", pair.face[side], faces));
      const Eigen::Vector3d& weights = pair.barycentric[side];
      if (!weights.allFinite() || weights.minCoeff() < -1e-6 || std::abs(weights.sum() - 1) > 1e-6) return corrupt("barycentric weights of a contact are not in the triangle");
    }
  }
  return {};
}

Outcome check_views(const Primitive& primitive) {
  const TrainingViews& views = primitive.training_views;
  if (views.descriptor_size < (views.stable_pose.empty() ? 0 : 1) || views.descriptors.size() != views.stable_pose.size() * static_cast<std::size_t>(views.descriptor_size))
    return corrupt(fmt::format("{} descriptor values, expected {} views of {}", views.descriptors.size(), views.stable_pose.size(), views.descriptor_size));
  for (const std::int32_t pose : views.stable_pose)
    if (pose < 0 || pose >= static_cast<std::int32_t>(primitive.stable_poses.size()))
      return corrupt(fmt::format("training view of stable pose {}, expected [0, {})", pose, primitive.stable_poses.size()));
  if (!std::all_of(views.descriptors.begin(), views.descriptors.end(), [](float value) { return std::isfinite(value); })) return corrupt("descriptors are not finite");
  return {};
}

Outcome check_hashes(const Primitive& primitive) {
  const std::uint64_t topology = topology_hash(*primitive.topology), content = content_hash(primitive);
  if (topology != primitive.topology->hash) return corrupt(fmt::format("topology hash = {:016x}, but the content's is {:016x}", primitive.topology->hash, topology));
  if (content != primitive.content_hash) return corrupt(fmt::format("content hash = {:016x}, but the content's is {:016x}", primitive.content_hash, content));
  return {};
}

}  // namespace

Result<void> check_primitive(const Primitive& primitive) {
  for (const auto check : {check_shape, check_numbers, check_poses, check_contacts, check_views, check_hashes})
    if (auto good = check(primitive); !good) return good;
  return {};
}

}  // namespace gfp::wire
