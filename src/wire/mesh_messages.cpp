#include "wire/mesh_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "wire/bounded_parse.hpp"
#include "wire/quantise.hpp"

namespace gfp::wire {
namespace {

static_assert(std::endian::native == std::endian::little, "wire arrays are little-endian and copied as they are");

template <class T>
void assign_array(std::string& bytes, const T* values, std::size_t count) {
  bytes.assign(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
std::vector<T> array_from(const std::string& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

Result<void> expect_bytes(const char* what, const std::string& bytes, std::size_t expected) {
  if (bytes.size() == expected) return {};
  return failure(ErrorCode::kCorruptData, fmt::format("{} has {} bytes, expected {}", what, bytes.size(), expected));
}

Result<std::vector<Triangle>> triangles_from(const char* what, const std::string& bytes, std::uint32_t vertices) {
  if (bytes.size() % sizeof(Triangle) != 0)
    return failure(ErrorCode::kCorruptData, fmt::format("{} has {} bytes, expected a multiple of {}", what, bytes.size(), sizeof(Triangle)));
  auto triangles = array_from<Triangle>(bytes);
  for (const Triangle& triangle : triangles)
    for (const std::int32_t index : triangle)
      if (index < 0 || static_cast<std::uint32_t>(index) >= vertices)
        return failure(ErrorCode::kCorruptData, fmt::format("{} names vertex {}, expected [0, {})", what, index, vertices));
  return triangles;
}

template <class Enum>
Result<std::vector<Enum>> enums_from(const char* what, const std::string& bytes, std::uint32_t vertices, Enum last) {
  std::vector<Enum> values;
  if (bytes.empty()) return values;
  if (auto sized = expect_bytes(what, bytes, vertices); !sized) return tl::unexpected(sized.error());
  values.reserve(bytes.size());
  for (const char byte : bytes) {
    const auto value = static_cast<std::uint8_t>(byte);
    if (value > static_cast<std::uint8_t>(last))
      return failure(ErrorCode::kCorruptData, fmt::format("{} has value {}, expected at most {}", what, value, static_cast<int>(last)));
    values.push_back(static_cast<Enum>(value));
  }
  return values;
}

/// x y z x y z... of the vertices.
std::span<const double> coordinates(const FittedModel& model) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double), "vertices lie one behind the other");
  return {model.vertices.empty() ? nullptr : model.vertices.front().data(), 3 * model.vertices.size()};
}

void fill_float32(const FittedModel& model, v1::Vertices& message) {
  constexpr std::size_t kBlock = 384;  // converted where the compiler can do several at a time, then copied
  std::array<float, kBlock> block;
  const std::span<const double> from = coordinates(model);
  const std::size_t count = from.size();
  std::string& positions = *message.mutable_positions();
  positions.resize(count * sizeof(float));
  for (std::size_t done = 0; done < count; done += kBlock) {
    const std::size_t size = std::min(kBlock, count - done);
    for (std::size_t i = 0; i < size; ++i) block[i] = static_cast<float>(from[done + i]);
    std::memcpy(positions.data() + done * sizeof(float), block.data(), size * sizeof(float));
  }
  assign_array(*message.mutable_sigma(), model.sigma_m.data(), model.sigma_m.size());
}

void fill_int16(const FittedModel& model, v1::Vertices& message) {
  const Bounds box = bounds(model.vertices);
  const Eigen::Vector3d origin = model.vertices.empty() ? Eigen::Vector3d(0, 0, 0) : box.centre();
  const double scale = model.vertices.empty() ? 1.0 : std::max(box.size().maxCoeff() / 65534.0, 1e-9);
  quantise_points(coordinates(model), origin.data(), scale, *message.mutable_positions());
  for (int axis = 0; axis < 3; ++axis) message.add_origin(origin[axis]);
  message.set_scale(scale);

  const double sigma_scale = std::max(static_cast<double>(largest_of(model.sigma_m)) / 65535.0, 1e-9);
  quantise_lengths(model.sigma_m, sigma_scale, *message.mutable_sigma());
  message.set_sigma_scale(sigma_scale);
}

Result<void> decode_float32(const v1::Vertices& message, DecodedVertices& decoded) {
  const std::size_t count = message.count();
  if (auto sized = expect_bytes("vertices.positions", message.positions(), 12 * count); !sized) return sized;
  if (!message.sigma().empty())
    if (auto sized = expect_bytes("vertices.sigma", message.sigma(), 4 * count); !sized) return sized;
  const auto values = array_from<float>(message.positions());
  for (std::size_t i = 0; i < count; ++i) decoded.positions.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  decoded.sigma_m = array_from<float>(message.sigma());
  return {};
}

Result<void> decode_int16(const v1::Vertices& message, DecodedVertices& decoded) {
  const std::size_t count = message.count();
  if (auto sized = expect_bytes("vertices.positions", message.positions(), 6 * count); !sized) return sized;
  if (!message.sigma().empty())
    if (auto sized = expect_bytes("vertices.sigma", message.sigma(), 2 * count); !sized) return sized;
  if (message.origin_size() != 3)
    return failure(ErrorCode::kCorruptData, fmt::format("vertices.origin has {} numbers, expected 3", message.origin_size()));
  const Eigen::Vector3d origin(message.origin(0), message.origin(1), message.origin(2));
  const auto values = array_from<std::int16_t>(message.positions());
  for (std::size_t i = 0; i < count; ++i)
    decoded.positions.push_back(origin + message.scale() * Eigen::Vector3d(values[3 * i], values[3 * i + 1], values[3 * i + 2]));
  for (const std::uint16_t sigma : array_from<std::uint16_t>(message.sigma()))
    decoded.sigma_m.push_back(static_cast<float>(message.sigma_scale() * sigma));
  return {};
}

}  // namespace

void fill(const Topology& topology, std::size_t vertex_count, v1::Topology& message) {
  message.set_hash(topology.hash);
  message.set_vertex_count(static_cast<std::uint32_t>(vertex_count));
  assign_array(*message.mutable_triangles(), topology.triangles.data(), topology.triangles.size());
  if (topology.filled_triangles != topology.triangles)
    assign_array(*message.mutable_filled_triangles(), topology.filled_triangles.data(), topology.filled_triangles.size());
  assign_array(*message.mutable_types(), topology.types.data(), topology.types.size());
  assign_array(*message.mutable_parts(), topology.parts.data(), topology.parts.size());
}

Result<Topology> topology_from(const v1::Topology& message) {
  const std::uint32_t count = message.vertex_count();
  if (count > kMaxVertices) return failure(ErrorCode::kTooLarge, fmt::format("topology has {} vertices, at most {} are read", count, kMaxVertices));
  auto triangles = triangles_from("topology.triangles", message.triangles(), count);
  if (!triangles) return tl::unexpected(triangles.error());
  auto filled = triangles_from("topology.filled_triangles", message.filled_triangles(), count);
  if (!filled) return tl::unexpected(filled.error());
  auto types = enums_from("topology.types", message.types(), count, PointType::kControl);
  if (!types) return tl::unexpected(types.error());
  auto parts = enums_from("topology.parts", message.parts(), count, Part::kSpout);
  if (!parts) return tl::unexpected(parts.error());
  Topology topology{std::move(*triangles), std::move(*filled), std::move(*types), std::move(*parts), message.hash()};
  if (topology.filled_triangles.empty()) topology.filled_triangles = topology.triangles;
  return topology;
}

void fill(const FittedModel& model, VertexCoding coding, v1::Vertices& message) {
  message.set_topology_hash(model.topology ? model.topology->hash : 0);
  message.set_count(static_cast<std::uint32_t>(model.vertices.size()));
  message.set_encoding(coding == VertexCoding::kFloat32 ? v1::Vertices::ENCODING_FLOAT32 : v1::Vertices::ENCODING_INT16);
  if (coding == VertexCoding::kFloat32) fill_float32(model, message);
  else fill_int16(model, message);
  assign_array(*message.mutable_states(), model.states.data(), model.states.size());
}

Result<DecodedVertices> vertices_from(const v1::Vertices& message) {
  if (message.count() > kMaxVertices)
    return failure(ErrorCode::kTooLarge, fmt::format("object has {} vertices, at most {} are read", message.count(), kMaxVertices));
  if (!message.states().empty())
    if (auto sized = expect_bytes("vertices.states", message.states(), message.count()); !sized) return tl::unexpected(sized.error());
  DecodedVertices decoded;
  Result<void> done;
  switch (message.encoding()) {
    case v1::Vertices::ENCODING_FLOAT32: done = decode_float32(message, decoded); break;
    case v1::Vertices::ENCODING_INT16: done = decode_int16(message, decoded); break;
    default: done = failure(ErrorCode::kUnsupported, fmt::format("vertices.encoding = {}, expected 0 or 1", static_cast<int>(message.encoding())));
  }
  if (!done) return tl::unexpected(done.error());
  decoded.states = array_from<std::uint8_t>(message.states());
  const bool finite = std::all_of(decoded.positions.begin(), decoded.positions.end(), [](const auto& p) { return p.allFinite(); });
  if (!finite) return failure(ErrorCode::kCorruptData, "vertices.positions are not all finite");
  return decoded;
}

}  // namespace gfp::wire
