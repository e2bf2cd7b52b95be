#include "collection/cavity.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

#include "gfp/core/union_find.hpp"
#include "gfp/evaluation/voxel_solid.hpp"

namespace gfp {
namespace {

constexpr double kVoxels = 90;           ///< Along the longest side.
constexpr double kLeastFilling = 1.2;    ///< Filled volume over material.

/// Triangles of which every vertex is beside the water.
std::vector<std::uint8_t> wet_triangles(const TriangleMesh& mesh, const FilledSolid& solid, double voxel_m) {
  const auto normals = vertex_normals(mesh);
  std::vector<std::uint8_t> wet(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < wet.size(); ++i) {
    const Eigen::Vector3d outside = mesh.vertices[i] + 2.5 * voxel_m * normals[i];
    wet[i] = solid.filled.contains(outside) && !solid.material.contains(outside);
  }
  std::vector<std::uint8_t> triangles;
  for (const Triangle& t : mesh.triangles)
    triangles.push_back(wet[static_cast<std::size_t>(t[0])] && wet[static_cast<std::size_t>(t[1])] && wet[static_cast<std::size_t>(t[2])]);
  return triangles;
}

/// Only the largest patch of wet triangles that hang together by their vertices.
void keep_largest(const TriangleMesh& mesh, std::vector<std::uint8_t>& wet) {
  UnionFind sets(mesh.vertices.size());
  std::map<std::int32_t, int> sizes;
  for (std::size_t t = 0; t < wet.size(); ++t)
    if (wet[t]) sets.join(mesh.triangles[t][0], mesh.triangles[t][1]), sets.join(mesh.triangles[t][0], mesh.triangles[t][2]);
  for (std::size_t t = 0; t < wet.size(); ++t)
    if (wet[t]) ++sizes[sets.root(mesh.triangles[t][0])];
  if (sizes.empty()) return;
  const auto most = std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
  for (std::size_t t = 0; t < wet.size(); ++t) wet[t] = wet[t] && sets.root(mesh.triangles[t][0]) == most;
}

/// The patch's border as one loop, in the direction of its triangles; empty where there are several or they touch.
std::vector<std::int32_t> rim_of(const TriangleMesh& mesh, const std::vector<std::uint8_t>& wet) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (std::size_t t = 0; t < wet.size(); ++t)
    for (std::size_t k = 0; k < 3 && wet[t]; ++k) ++edges[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}];
  std::map<std::int32_t, std::int32_t> next;
  for (const auto& [edge, count] : edges) {
    if (edges.contains({edge.second, edge.first})) continue;
    if (!next.try_emplace(edge.first, edge.second).second) return {};
  }
  if (next.empty()) return {};
  std::vector<std::int32_t> loop{next.begin()->first};
  while (next.contains(loop.back()) && next[loop.back()] != loop.front() && loop.size() <= next.size()) loop.push_back(next[loop.back()]);
  return loop.size() == next.size() ? loop : std::vector<std::int32_t>{};
}

}  // namespace

Cavity find_cavity(const TriangleMesh& mesh) {
  Cavity cavity{false, std::vector<Part>(mesh.vertices.size(), Part::kBody), mesh.triangles};
  const double voxel_m = bounds(mesh.vertices).size().maxCoeff() / kVoxels;
  const auto solid = fill_solid(mesh, voxel_m);
  if (!solid || solid->filled.volume_m3() < kLeastFilling * solid->material.volume_m3()) return cavity;
  std::vector<std::uint8_t> wet = wet_triangles(mesh, *solid, voxel_m);
  keep_largest(mesh, wet);
  const std::vector<std::int32_t> rim = rim_of(mesh, wet);
  if (rim.size() < 3) return cavity;
  cavity.found = true;
  cavity.filled_triangles.clear();
  for (std::size_t t = 0; t < wet.size(); ++t) {
    if (!wet[t]) {
      cavity.filled_triangles.push_back(mesh.triangles[t]);
      continue;
    }
    for (const std::int32_t v : mesh.triangles[t]) cavity.parts[static_cast<std::size_t>(v)] = Part::kInnerWall;
  }
  for (std::size_t k = 1; k + 1 < rim.size(); ++k) cavity.filled_triangles.push_back({rim[0], rim[k], rim[k + 1]});
  return cavity;
}

}  // namespace gfp
