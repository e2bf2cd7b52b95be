#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gfp/core/transform.hpp"

namespace gfp {

using Triangle = std::array<std::int32_t, 3>;  ///< Counter-clockwise seen from outside.

/// Indexed triangle mesh, metres. The frame is said by whoever holds it.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
};

struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = Eigen::Vector3d::Constant(-1e300);
  void include(const Eigen::Vector3d& point) { low = low.cwiseMin(point); high = high.cwiseMax(point); }
  Eigen::Vector3d size() const { return high - low; }
  Eigen::Vector3d centre() const { return 0.5 * (low + high); }
};

/// How a mesh is connected. `closed`: every edge has exactly two triangles, walked in opposite directions, and every
/// vertex is used by one fan (manifold and consistently oriented). Holds for any number of components.
struct MeshTopology {
  bool closed = false;
  int boundary_edges = 0;
  int nonmanifold_edges = 0;  ///< More than two triangles, or two that are oriented against each other.
  int nonmanifold_vertices = 0;
  int components = 0;
  int euler_characteristic = 0;  ///< V - E + F over used vertices; 2 - 2 genus for one closed component.
};

MeshTopology examine_topology(const TriangleMesh& mesh);

/// Signed volume enclosed (divergence theorem), m^3; positive when triangles face outwards.
double signed_volume(const TriangleMesh& mesh);
double surface_area(const TriangleMesh& mesh);
Eigen::Vector3d volume_centroid(const TriangleMesh& mesh);
Bounds bounds(const std::vector<Eigen::Vector3d>& points);

std::vector<Eigen::Vector3d> triangle_normals(const TriangleMesh& mesh);       ///< Unit; zero where degenerate.
std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh);         ///< Angle-weighted, unit.

/// Neighbours by edge of every vertex, compressed rows: neighbours of i are indices[offsets[i] .. offsets[i + 1]), ascending.
struct VertexAdjacency {
  std::vector<std::int32_t> offsets, indices;
};
VertexAdjacency vertex_adjacency(const TriangleMesh& mesh);
double mean_edge_length(const TriangleMesh& mesh);

/// Pairs of triangles that cross, not counting pairs which share a vertex or an edge (unless they overlap in one plane
/// beyond what they share). Exact to rounding: coordinates in metres, tolerance 1e-12. Stops counting at `limit`.
/// Cost: uniform grid, about 5 ms for 1200 triangles.
int count_self_intersections(const TriangleMesh& mesh, int limit = 1 << 30);

std::vector<Eigen::Vector3d> transformed(const std::vector<Eigen::Vector3d>& points, const Transform& T_to_from);
TriangleMesh transformed(const TriangleMesh& mesh, const Transform& T_to_from);
/// Puts one mesh's triangles behind another's.
void append(TriangleMesh& mesh, const TriangleMesh& more);

/// Smallest sphere that holds all points, exact to 1e-9 of its radius (Welzl with move-to-front, Gartner 1999).
struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};
Sphere circumscribed_sphere(const std::vector<Eigen::Vector3d>& points);

}  // namespace gfp
