#include "gfp/core/simplified.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/decimate.hpp"
#include "gfp/core/self_intersections.hpp"
#include "gfp/core/split_triangle.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kSplit = 1.4, kLongest = 2.0;  ///< Longest edges before and after decimation, in edges of an even mesh with as many vertices.
constexpr int kTries = 8;                       ///< With what crossed left as fine as it was.
constexpr int kSplitRounds = 12;
constexpr std::size_t kMostTriangles = 50'000;  ///< Needles are not split beyond.

/// Halves edges longer than the bound; the surface stays where it is.
TriangleMesh with_short_edges(TriangleMesh mesh, double longest) {
  for (int round = 0; round < kSplitRounds && mesh.triangles.size() < kMostTriangles; ++round) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) -> std::int32_t {
      const Vector3d p = mesh.vertices[static_cast<std::size_t>(a)], q = mesh.vertices[static_cast<std::size_t>(b)];
      if ((p - q).squaredNorm() <= longest * longest) return -1;
      const auto [place, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::int32_t>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back(0.5 * (p + q));
      return place->second;
    };
    std::vector<Triangle> divided;
    for (const Triangle& t : mesh.triangles) split_triangle(t, {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])}, divided);
    if (middles.empty()) break;
    mesh.triangles = std::move(divided);
  }
  return mesh;
}

/// Locks the vertices around the triangles that cross.
void lock_around(const TriangleMesh& few, const std::vector<std::array<std::int32_t, 2>>& crossings, const TriangleMesh& mesh, std::vector<std::uint8_t>& locked) {
  for (const auto& pair : crossings) {
    Bounds box;
    for (const auto t : pair)
      for (const auto v : few.triangles[static_cast<std::size_t>(t)]) box.include(few.vertices[static_cast<std::size_t>(v)]);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      if ((mesh.vertices[i].array() >= box.low.array()).all() && (mesh.vertices[i].array() <= box.high.array()).all()) locked[i] = 1;
  }
}

}  // namespace

Result<TriangleMesh> simplified(const TriangleMesh& mesh, int vertices) {
  const double even_edge = std::sqrt(surface_area(mesh) / (0.866 * vertices));  // equilateral triangles, two a vertex
  TriangleMesh now = with_short_edges(mesh, kSplit * even_edge);
  std::vector<std::uint8_t> locked(now.vertices.size(), 0);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    TriangleMesh few = decimated(now, vertices, kLongest * even_edge, locked);
    const auto crossings = find_self_intersections(few);
    if (crossings.empty()) return few;
    lock_around(few, crossings, now, locked);
  }
  return failure(ErrorCode::kDegenerateGeometry, "the surface crosses itself when it is simplified to " + std::to_string(vertices) + " vertices");
}

}  // namespace gfp
