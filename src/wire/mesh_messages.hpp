#pragma once

#include <memory>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/v1/mesh.pb.h"

namespace gfp::wire {

/// How vertices travel (proto/gfp/v1/mesh.proto). int16 is half as large; its error is at most half of
/// (longest side / 65534): 1.2 micrometres for 0.16 m.
enum class VertexCoding { kFloat32, kInt16 };

void fill(const Topology& topology, std::size_t vertex_count, v1::Topology& message);

/// Errors: kTooLarge (more than kMaxVertices), kCorruptData (a length that does not fit, an index beyond the vertices).
Result<Topology> topology_from(const v1::Topology& message);

/// Positions, states and sigma of a fit.
void fill(const FittedModel& model, VertexCoding coding, v1::Vertices& message);

struct DecodedVertices {
  std::vector<Eigen::Vector3d> positions;  ///< Object frame, metres.
  std::vector<std::uint8_t> states;
  std::vector<float> sigma_m;
};

/// Errors: kTooLarge, kCorruptData (a length that does not fit the count, positions that are not finite).
Result<DecodedVertices> vertices_from(const v1::Vertices& message);

}  // namespace gfp::wire
