#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// Points spread over a surface, with the unit normals of their triangles.
struct SurfaceSamples {
  std::vector<Eigen::Vector3d> points, normals;
};

/// `count` points, uniform by area: one in each of `count` equal stretches of the cumulated area, so that their means have less
/// variance than independent points. Deterministic for a seed. Empty for a mesh without area.
SurfaceSamples sample_surface(const TriangleMesh& mesh, int count, std::uint64_t seed);

}  // namespace gfp
