#include "wire/primitive_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "gfp/v1/primitive.pb.h"
#include "wire/bounded_parse.hpp"
#include "wire/mesh_messages.hpp"
#include "wire/primitive_check.hpp"

namespace gfp::wire {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;

void put_points(const std::vector<Eigen::Vector3d>& points, Doubles& out) {
  out.Reserve(static_cast<int>(3 * points.size()));
  for (const auto& p : points)
    for (int axis = 0; axis < 3; ++axis) out.Add(p[axis]);
}

template <class Derived>
void put_matrix(const Eigen::MatrixBase<Derived>& matrix, Doubles& out) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) out.Add(matrix(row, column));
}

std::vector<Eigen::Vector3d> points_from(const Doubles& values) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(values.size() / 3));
  for (int i = 0; i + 2 < values.size(); i += 3) points.emplace_back(values[i], values[i + 1], values[i + 2]);
  return points;
}

Eigen::Matrix3d matrix_from(const Doubles& values) { return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data()); }

Result<void> expect_count(const char* what, int count, std::size_t expected) {
  if (static_cast<std::size_t>(count) == expected) return {};
  return failure(ErrorCode::kCorruptData, fmt::format("{} has {} values, expected {}", what, count, expected));
}

Result<void> expect_at_most(const char* what, int count, int most) {
  if (count <= most) return {};
  return failure(ErrorCode::kTooLarge, fmt::format("{} has {} entries, at most {}", what, count, most));
}

void fill(const Primitive& primitive, v1::Primitive& message) {
  message.set_schema_version(Primitive::kSchemaVersion);
  message.set_name(primitive.name);
  message.set_class_name(primitive.class_name);
  for (const auto& alias : primitive.aliases) message.add_aliases(alias);
  wire::fill(*primitive.topology, primitive.size(), *message.mutable_topology());
  put_points(primitive.mean, *message.mutable_mean());
  for (std::size_t k = 0; k < primitive.modes.size(); ++k) {
    auto& mode = *message.add_modes();
    put_points(primitive.modes[k], *mode.mutable_displacement());
    mode.set_sigma(primitive.mode_sigma[k]);
  }
  put_matrix(primitive.log_size_mean, *message.mutable_log_size_mean());
  put_matrix(primitive.log_size_covariance, *message.mutable_log_size_covariance());
  message.set_residual_sigma(primitive.residual_sigma);
  auto& symmetry = *message.mutable_symmetry();
  symmetry.set_revolution(primitive.symmetry.revolution);
  symmetry.set_cyclic(primitive.symmetry.cyclic);
  symmetry.set_mirror_x(primitive.symmetry.mirror_x);
  symmetry.set_mirror_y(primitive.symmetry.mirror_y);
  symmetry.set_flip_z(primitive.symmetry.flip_z);
  message.set_genus(primitive.genus);
  message.set_hollow(primitive.hollow);
  for (const auto& pose : primitive.stable_poses) {
    auto& stable = *message.add_stable_poses();
    put_matrix(pose.R_support_object, *stable.mutable_rotation());
    stable.set_probability(pose.probability);
    stable.set_name(pose.name);
  }
  for (const auto& pair : primitive.contact_pairs) {
    auto& contact = *message.add_contact_pairs();
    for (int side = 0; side < 2; ++side) {
      contact.add_face(pair.face[side]);
      put_matrix(pair.barycentric[side], *contact.mutable_barycentric());
    }
  }
  for (const auto& type : primitive.manual_types) message.mutable_manual_types()->push_back(static_cast<char>(type ? 1 + static_cast<int>(*type) : 0));
  message.set_rest_edge_length(primitive.rest_edge_length);
  message.set_features(primitive.features);
  message.set_source(primitive.provenance.source);
  message.set_licence(primitive.provenance.licence);
  message.set_members(primitive.provenance.members);
  const TrainingViews& views = primitive.training_views;
  if (!views.stable_pose.empty()) {
    auto& trained = *message.mutable_training_views();
    trained.set_descriptor_size(views.descriptor_size);
    trained.mutable_stable_pose()->Add(views.stable_pose.begin(), views.stable_pose.end());
    trained.mutable_descriptors()->Add(views.descriptors.begin(), views.descriptors.end());
  }
  message.set_content_hash(primitive.content_hash);
}

/// Every length, before anything is read through it.
Result<void> check_lengths(const v1::Primitive& message) {
  if (message.schema_version() != Primitive::kSchemaVersion)
    return failure(ErrorCode::kUnsupported, fmt::format("schema_version = {}, expected {}", message.schema_version(), Primitive::kSchemaVersion));
  const std::uint32_t vertices = message.topology().vertex_count();
  if (vertices > kMaxPrimitiveVertices) return failure(ErrorCode::kTooLarge, fmt::format("{} vertices, at most {}", vertices, kMaxPrimitiveVertices));
  for (const auto& [what, count, most] : {std::tuple{"aliases", message.aliases_size(), 1000}, {"modes", message.modes_size(), kMaxModes},
                                          {"stable_poses", message.stable_poses_size(), 1000}, {"contact_pairs", message.contact_pairs_size(), kMaxListItems}})
    if (auto good = expect_at_most(what, count, most); !good) return good;
  std::vector<std::tuple<const char*, int, std::size_t>> expected{{"mean", message.mean_size(), 3 * std::size_t{vertices}},
                                                                  {"log_size_mean", message.log_size_mean_size(), 3},
                                                                  {"log_size_covariance", message.log_size_covariance_size(), 9}};
  for (const auto& mode : message.modes()) expected.emplace_back("a mode", mode.displacement_size(), 3 * std::size_t{vertices});
  for (const auto& pose : message.stable_poses()) expected.emplace_back("a stable pose", pose.rotation_size(), 9);
  for (const auto& pair : message.contact_pairs()) {
    expected.emplace_back("a contact pair's face", pair.face_size(), 2);
    expected.emplace_back("a contact pair's barycentric", pair.barycentric_size(), 6);
  }
  if (!message.manual_types().empty()) expected.emplace_back("manual_types", static_cast<int>(message.manual_types().size()), std::size_t{vertices});
  for (const auto& [what, count, wanted] : expected)
    if (auto good = expect_count(what, count, wanted); !good) return good;
  return {};
}

Result<std::vector<std::optional<PointType>>> manual_types_from(const std::string& bytes) {
  std::vector<std::optional<PointType>> types;
  for (const char byte : bytes) {
    if (byte < 0 || byte > 2) return failure(ErrorCode::kCorruptData, fmt::format("manual type {}, expected [0, 2]", static_cast<int>(byte)));
    types.push_back(byte == 0 ? std::nullopt : std::optional(static_cast<PointType>(byte - 1)));
  }
  return types;
}

Result<Primitive> primitive_from(const v1::Primitive& message) {
  if (auto good = check_lengths(message); !good) return tl::unexpected(good.error());
  auto topology = topology_from(message.topology());
  if (!topology) return tl::unexpected(topology.error());
  auto manual = manual_types_from(message.manual_types());
  if (!manual) return tl::unexpected(manual.error());
  Primitive primitive;
  primitive.name = message.name();
  primitive.class_name = message.class_name();
  primitive.aliases.assign(message.aliases().begin(), message.aliases().end());
  primitive.mean = points_from(message.mean());
  primitive.topology = std::make_shared<const Topology>(std::move(*topology));
  for (const auto& mode : message.modes()) {
    primitive.modes.push_back(points_from(mode.displacement()));
    primitive.mode_sigma.push_back(mode.sigma());
  }
  primitive.log_size_mean = points_from(message.log_size_mean())[0];
  primitive.log_size_covariance = matrix_from(message.log_size_covariance());
  primitive.residual_sigma = message.residual_sigma();
  const auto& symmetry = message.symmetry();
  primitive.symmetry = {symmetry.revolution(), symmetry.cyclic(), symmetry.mirror_x(), symmetry.mirror_y(), symmetry.flip_z()};
  primitive.genus = message.genus();
  primitive.hollow = message.hollow();
  for (const auto& pose : message.stable_poses()) primitive.stable_poses.push_back({matrix_from(pose.rotation()), pose.probability(), pose.name()});
  for (const auto& pair : message.contact_pairs()) {
    const auto weights = points_from(pair.barycentric());
    primitive.contact_pairs.push_back({{pair.face(0), pair.face(1)}, {weights[0], weights[1]}});
  }
  primitive.manual_types = std::move(*manual);
  primitive.rest_edge_length = message.rest_edge_length();
  primitive.features = message.features();
  primitive.provenance = {message.source(), message.licence(), message.members()};
  const auto& views = message.training_views();
  primitive.training_views = {views.descriptor_size(), {views.stable_pose().begin(), views.stable_pose().end()}, {views.descriptors().begin(), views.descriptors().end()}};
  primitive.content_hash = message.content_hash();
  if (auto good = check_primitive(primitive); !good) return tl::unexpected(good.error());
  return primitive;
}

tl::unexpected<Error> in_file(const std::filesystem::path& file, const Error& error) { return tl::unexpected(Error{error.code, file.string() + ": " + error.what}); }

}  // namespace

std::string encode_primitive(const Primitive& primitive) {
  v1::Primitive message;
  fill(primitive, message);
  return message.SerializeAsString();
}

Result<Primitive> decode_primitive(std::span<const std::byte> bytes) {
  v1::Primitive message;
  if (auto parsed = parse_bounded(bytes, kMaxPrimitiveBytes, message); !parsed) return tl::unexpected(parsed.error());
  return primitive_from(message);
}

std::string encode_primitives(const std::vector<Primitive>& primitives) {
  v1::PrimitiveSet set;
  for (const auto& primitive : primitives) fill(primitive, *set.add_primitives());
  return set.SerializeAsString();
}

Result<std::vector<Primitive>> decode_primitives(std::span<const std::byte> bytes) {
  v1::PrimitiveSet set;
  if (auto parsed = parse_bounded(bytes, kMaxPrimitiveBytes, set); !parsed) return tl::unexpected(parsed.error());
  std::vector<Primitive> primitives;
  for (const auto& message : set.primitives()) {
    auto primitive = primitive_from(message);
    if (!primitive) return tl::unexpected(Error{primitive.error().code, "primitive '" + message.name().substr(0, 80) + "': " + primitive.error().what});
    primitives.push_back(std::move(*primitive));
  }
  return primitives;
}

Result<Primitive> read_primitive(const std::filesystem::path& file) {
  std::error_code status;
  const auto bytes = std::filesystem::file_size(file, status);
  if (status) return failure(ErrorCode::kNotFound, file.string() + ": " + status.message());
  if (bytes > kMaxPrimitiveBytes) return failure(ErrorCode::kTooLarge, fmt::format("{}: {} bytes, at most {}", file.string(), bytes, kMaxPrimitiveBytes));
  std::ifstream stream(file, std::ios::binary);
  std::string content(bytes, '\0');
  if (!stream.read(content.data(), static_cast<std::streamsize>(bytes))) return failure(ErrorCode::kIo, file.string() + ": cannot be read");
  auto primitive = decode_primitive(as_bytes(content));
  if (!primitive) return in_file(file, primitive.error());
  return primitive;
}

Result<void> write_primitive(const std::filesystem::path& file, const Primitive& primitive) {
  const std::string bytes = encode_primitive(primitive);
  const std::filesystem::path unfinished = file.string() + ".unfinished";
  std::ofstream stream(unfinished, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (!stream || error) return failure(ErrorCode::kIo, file.string() + ": cannot be written");
  return {};
}

Result<std::vector<Primitive>> read_primitive_folder(const std::filesystem::path& folder) {
  std::error_code status;
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator entry(folder, status), end; !status && entry != end; entry.increment(status))
    if (entry->path().extension() == ".gfp") files.push_back(entry->path());
  if (status) return failure(ErrorCode::kNotFound, folder.string() + ": " + status.message());
  std::sort(files.begin(), files.end());
  std::vector<Primitive> primitives;
  for (const auto& file : files) {
    auto primitive = read_primitive(file);
    if (!primitive) return tl::unexpected(primitive.error());
    primitives.push_back(std::move(*primitive));
  }
  return primitives;
}

}  // namespace gfp::wire
