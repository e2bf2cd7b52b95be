#include "gfp/primitive/content_hash.hpp"

#include <string>

#include "gfp/core/sha256.hpp"

namespace gfp {
namespace {

void put_text(Sha256& sha, const std::string& text) { sha.put_values(std::vector<char>(text.begin(), text.end())); }

void put_points(Sha256& sha, const std::vector<Eigen::Vector3d>& points) {
  sha.put_value(static_cast<std::uint64_t>(points.size()));
  for (const auto& p : points)
    for (int axis = 0; axis < 3; ++axis) sha.put_value(p[axis]);
}

template <class Derived>
void put_matrix(Sha256& sha, const Eigen::MatrixBase<Derived>& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) sha.put_value(static_cast<double>(matrix(row, column)));
}

void put_symmetry(Sha256& sha, const Symmetry& symmetry) {
  sha.put_value(static_cast<std::int32_t>(symmetry.cyclic));
  for (const bool flag : {symmetry.revolution, symmetry.mirror_x, symmetry.mirror_y, symmetry.flip_z}) sha.put_value(static_cast<std::uint8_t>(flag));
}

void put_pairs(Sha256& sha, const std::vector<ContactPair>& pairs) {
  sha.put_value(static_cast<std::uint64_t>(pairs.size()));
  for (const auto& pair : pairs) {
    for (int side = 0; side < 2; ++side) {
      sha.put_value(pair.face[side]);
      put_matrix(sha, pair.barycentric[side]);
    }
  }
}

}  // namespace

std::uint64_t topology_hash(const Topology& topology) {
  Sha256 sha;
  sha.put_values(topology.triangles);
  sha.put_values(topology.filled_triangles);
  sha.put_values(topology.types);
  sha.put_values(topology.parts);
  return sha.digest64();
}

std::uint64_t content_hash(const Primitive& primitive) {
  Sha256 sha;
  sha.put_value(Primitive::kSchemaVersion);
  put_text(sha, primitive.name);
  put_text(sha, primitive.class_name);
  for (const auto& alias : primitive.aliases) put_text(sha, alias);
  put_points(sha, primitive.mean);
  sha.put_value(topology_hash(*primitive.topology));
  for (const auto& mode : primitive.modes) put_points(sha, mode);
  sha.put_values(primitive.mode_sigma);
  put_matrix(sha, primitive.log_size_mean);
  put_matrix(sha, primitive.log_size_covariance);
  sha.put_value(primitive.residual_sigma);
  put_symmetry(sha, primitive.symmetry);
  sha.put_value(static_cast<std::int32_t>(primitive.genus));
  sha.put_value(static_cast<std::uint8_t>(primitive.hollow));
  for (const auto& pose : primitive.stable_poses) {
    put_matrix(sha, pose.R_support_object);
    sha.put_value(pose.probability);
    put_text(sha, pose.name);
  }
  put_pairs(sha, primitive.contact_pairs);
  for (const auto& type : primitive.manual_types) sha.put_value(static_cast<std::uint8_t>(type ? 1 + static_cast<int>(*type) : 0));
  sha.put_value(primitive.rest_edge_length);
  sha.put_value(static_cast<std::int32_t>(primitive.features));
  put_text(sha, primitive.provenance.source);
  put_text(sha, primitive.provenance.licence);
  sha.put_value(static_cast<std::int32_t>(primitive.provenance.members));
  return sha.digest64();
}

}  // namespace gfp
