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
constexpr int kTries = 4;                       ///< With half as many vertices more each time.
constexpr int kSplitRounds = 12;

/// Halves edges longer than the bound; the surface stays where it is.
TriangleMesh with_short_edges(TriangleMesh mesh, double longest) {
  for (int round = 0; round < kSplitRounds; ++round) {
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

}  // namespace

Result<TriangleMesh> simplified(const TriangleMesh& mesh, int vertices) {
  const double area = surface_area(mesh);
  double wanted = vertices;
  for (int attempt = 0; attempt < kTries; ++attempt, wanted *= 1.5) {
    const double even_edge = std::sqrt(area / (0.866 * wanted));  // equilateral triangles, two a vertex
    TriangleMesh few = decimated(with_short_edges(mesh, kSplit * even_edge), static_cast<int>(wanted), kLongest * even_edge);
    if (count_self_intersections(few, 1) == 0) return few;
  }
  return failure(ErrorCode::kDegenerateGeometry, "the surface crosses itself with " + std::to_string(static_cast<int>(wanted / 1.5)) + " vertices");
}

}  // namespace gfp
