#include "gfp/core/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "gfp/core/elementary.hpp"
#include "gfp/core/union_find.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kPointsAtATime = 8;

/// Eight boxes, x y z x y z..., each of every eighth point: the compiler makes them several numbers at a time.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void widen_boxes(const double* values, std::size_t blocks, double* low, double* high) {
  constexpr std::size_t kLanes = 3 * kPointsAtATime;
  for (std::size_t block = 0; block < blocks; ++block, values += kLanes)
    for (std::size_t i = 0; i < kLanes; ++i) {
      low[i] = values[i] < low[i] ? values[i] : low[i];
      high[i] = values[i] > high[i] ? values[i] : high[i];
    }
}

struct HalfEdge {
  std::int32_t low, high, triangle;
  bool forward;  ///< Walked from low to high.
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  }
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto a = mesh.triangles[t][static_cast<std::size_t>(k)];
      const auto b = mesh.triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Vertices whose triangles do not form one fan: the triangles about a vertex, joined over shared edges, must be one group.
int count_nonmanifold_vertices(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges) {
  UnionFind corners(3 * mesh.triangles.size());
  const auto corner = [&](std::int32_t triangle, std::int32_t vertex) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(triangle)];
    return 3 * triangle + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
  };
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const HalfEdge &a = edges[e], &b = edges[e + 1];
    if (a.low != b.low || a.high != b.high) continue;
    corners.join(corner(a.triangle, a.low), corner(b.triangle, a.low));
    corners.join(corner(a.triangle, a.high), corner(b.triangle, a.high));
  }
  std::vector<int> fans(mesh.vertices.size(), 0);
  for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c)
    if (corners.root(static_cast<int>(c)) == static_cast<int>(c)) ++fans[static_cast<std::size_t>(mesh.triangles[c / 3][c % 3])];
  return static_cast<int>(std::count_if(fans.begin(), fans.end(), [](int n) { return n > 1; }));
}

Vector3d area_vector(const TriangleMesh& mesh, const Triangle& t) {
  const Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  return 0.5 * (mesh.vertices[static_cast<std::size_t>(t[1])] - a).cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a);
}

}  // namespace

MeshTopology examine_topology(const TriangleMesh& mesh) {
  MeshTopology result;
  const auto edges = sorted_half_edges(mesh);
  UnionFind pieces(mesh.vertices.size());
  int edge_count = 0;
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first;
    int forward = 0;
    for (; last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high; ++last)
      forward += edges[last].forward ? 1 : 0;
    const auto uses = static_cast<int>(last - first);
    pieces.join(edges[first].low, edges[first].high);
    ++edge_count;
    if (uses == 1) ++result.boundary_edges;
    if (uses > 2 || (uses == 2 && forward != 1) || edges[first].low == edges[first].high) ++result.nonmanifold_edges;
    first = last;
  }
  result.nonmanifold_vertices = count_nonmanifold_vertices(mesh, edges);

  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const auto v : t) used[static_cast<std::size_t>(v)] = 1;
  int used_count = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    ++used_count;
    if (pieces.root(static_cast<int>(v)) == static_cast<int>(v)) ++result.components;
  }
  result.euler_characteristic = used_count - edge_count + static_cast<int>(mesh.triangles.size());
  result.closed = !mesh.triangles.empty() && result.boundary_edges == 0 && result.nonmanifold_edges == 0 && result.nonmanifold_vertices == 0;
  return result;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vector3d& origin = mesh.vertices.front();  // near the mesh: keeps the sum's rounding small
  double six_volumes = 0;
  for (const auto& t : mesh.triangles)
    six_volumes += (mesh.vertices[static_cast<std::size_t>(t[0])] - origin)
                       .dot((mesh.vertices[static_cast<std::size_t>(t[1])] - origin).cross(mesh.vertices[static_cast<std::size_t>(t[2])] - origin));
  return six_volumes / 6.0;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) area += area_vector(mesh, t).norm();
  return area;
}

Vector3d volume_centroid(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return Vector3d::Zero();
  const Vector3d origin = mesh.vertices.front();
  Vector3d moment = Vector3d::Zero();
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[static_cast<std::size_t>(t[0])] - origin;
    const Vector3d b = mesh.vertices[static_cast<std::size_t>(t[1])] - origin;
    const Vector3d c = mesh.vertices[static_cast<std::size_t>(t[2])] - origin;
    const double six_volume = a.dot(b.cross(c));
    moment += six_volume * (a + b + c) / 4.0;
    six_volumes += six_volume;
  }
  if (std::abs(six_volumes) < 1e-18) return bounds(mesh.vertices).centre();
  return origin + moment / six_volumes;
}

Bounds bounds(const std::vector<Vector3d>& points) {
  static_assert(sizeof(Vector3d) == 3 * sizeof(double), "points lie one behind the other");
  const std::size_t blocks = points.size() / kPointsAtATime;
  std::array<Vector3d, kPointsAtATime> lows, highs;
  lows.fill(Bounds().low);
  highs.fill(Bounds().high);
  if (blocks > 0) widen_boxes(points.front().data(), blocks, lows.front().data(), highs.front().data());
  Bounds box;
  for (std::size_t i = 0; i < kPointsAtATime; ++i) box.low = box.low.cwiseMin(lows[i]), box.high = box.high.cwiseMax(highs[i]);
  for (std::size_t i = blocks * kPointsAtATime; i < points.size(); ++i) box.include(points[i]);
  return box;
}

std::vector<Vector3d> triangle_normals(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Vector3d area = area_vector(mesh, t);
    const double norm = area.norm();
    normals.push_back(norm > 0 ? Vector3d(area / norm) : Vector3d(Vector3d::Zero()));
  }
  return normals;
}

std::vector<Vector3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  const auto faces = triangle_normals(mesh);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& t = mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(t[k]);
      const Vector3d a = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])] - mesh.vertices[i];
      const Vector3d b = mesh.vertices[static_cast<std::size_t>(t[(k + 2) % 3])] - mesh.vertices[i];
      normals[i] += fast_angle(a.cross(b).norm(), a.dot(b)) * faces[f];
    }
  }
  for (auto& n : normals) {
    const double norm = n.norm();
    if (norm > 0) n /= norm;
  }
  return normals;
}

VertexAdjacency vertex_adjacency(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  // Every edge of a triangle, both ways, counting-sorted by where it begins; lists are short.
  std::vector<std::int32_t> starts(vertices + 1, 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) starts[static_cast<std::size_t>(v) + 1] += 2;
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::int32_t> ends(static_cast<std::size_t>(starts.back())), next(starts.begin(), starts.end() - 1);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) ends[static_cast<std::size_t>(next[static_cast<std::size_t>(t[k])]++)] = t[other];
  VertexAdjacency adjacency;
  adjacency.offsets.assign(vertices + 1, 0);
  adjacency.indices.reserve(ends.size() / 2);
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto first = ends.begin() + starts[v], last = ends.begin() + starts[v + 1];
    std::sort(first, last);
    adjacency.indices.insert(adjacency.indices.end(), first, std::unique(first, last));
    adjacency.offsets[v + 1] = static_cast<std::int32_t>(adjacency.indices.size());
  }
  return adjacency;
}

double mean_edge_length(const TriangleMesh& mesh) {
  const auto adjacency = vertex_adjacency(mesh);
  double sum = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (auto k = adjacency.offsets[i]; k < adjacency.offsets[i + 1]; ++k)
      sum += (mesh.vertices[i] - mesh.vertices[static_cast<std::size_t>(adjacency.indices[static_cast<std::size_t>(k)])]).norm();
  return adjacency.indices.empty() ? 0 : sum / static_cast<double>(adjacency.indices.size());
}

std::vector<Vector3d> transformed(const std::vector<Vector3d>& points, const Transform& T_to_from) {
  std::vector<Vector3d> result;
  result.reserve(points.size());
  for (const auto& p : points) result.push_back(T_to_from * p);
  return result;
}

TriangleMesh transformed(const TriangleMesh& mesh, const Transform& T_to_from) { return {transformed(mesh.vertices, T_to_from), mesh.triangles}; }

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto offset = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

}  // namespace gfp
