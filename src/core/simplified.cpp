#include "gfp/core/simplified.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/decimate.hpp"
#include "gfp/core/self_intersections.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kSplit = 1.4, kLongest = 2.0;  ///< Longest edges before and after decimation, in edges of an even mesh with as many vertices.
constexpr int kTries = 4;                       ///< With half as many vertices more each time.
constexpr int kSplitRounds = 12;

/// One triangle as up to four, by the middles (or -1) of its edges (0, 1), (1, 2), (2, 0).
void divide(Triangle t, std::array<std::int32_t, 3> middle, std::vector<Triangle>& out) {
  const auto split = std::count_if(middle.begin(), middle.end(), [](std::int32_t m) { return m >= 0; });
  if (split == 0) return out.push_back(t);
  if (split == 3) {
    out.insert(out.end(), {{t[0], middle[0], middle[2]}, {middle[0], t[1], middle[1]}, {middle[2], middle[1], t[2]}, {middle[0], middle[1], middle[2]}});
    return;
  }
  // Turned so that the first edge is split, and with two of them the third is not.
  while (middle[0] < 0 || (split == 2 && middle[2] >= 0)) {
    std::rotate(t.begin(), t.begin() + 1, t.end());
    std::rotate(middle.begin(), middle.begin() + 1, middle.end());
  }
  if (split == 1) out.insert(out.end(), {{t[0], middle[0], t[2]}, {middle[0], t[1], t[2]}});
  else out.insert(out.end(), {{middle[0], t[1], middle[1]}, {t[0], middle[0], middle[1]}, {t[0], middle[1], t[2]}});
}

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
    for (const Triangle& t : mesh.triangles) divide(t, {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])}, divided);
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
