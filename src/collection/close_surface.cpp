#include "gfp/collection/close_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collection/extract_border.hpp"
#include "gfp/core/self_intersections.hpp"
#include "gfp/core/simplified.hpp"
#include "gfp/evaluation/triangle_tree.hpp"
#include "gfp/evaluation/voxel_solid.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kWeldShare = 1e-6;           ///< Vertices nearer than this share of the longest side are one.
constexpr std::size_t kMostAsIs = 100'000;    ///< Triangles of a mesh that is looked at as it is: beyond, the search for crossings takes seconds.
constexpr double kReach = 3.0;                ///< Voxels over which the border is drawn back onto the triangles.
constexpr double kLeastThickness = 0.6;       ///< Voxels: what sheets and thinner walls are given.

/// Equal vertices made one, those of no triangle and what then is no triangle left out.
TriangleMesh welded(const TriangleMesh& soup, const Vector3d& low, double weld_m) {
  std::vector<std::int32_t> corners;
  for (const Triangle& t : soup.triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  using Cell = std::array<long long, 3>;
  std::vector<std::pair<Cell, std::int32_t>> order;
  for (const auto v : corners) {
    const Vector3d p = (soup.vertices[static_cast<std::size_t>(v)] - low) / weld_m;
    order.push_back({Cell{std::llround(p.x()), std::llround(p.y()), std::llround(p.z())}, v});
  }
  std::sort(order.begin(), order.end());
  TriangleMesh mesh;
  std::vector<std::int32_t> place(soup.vertices.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || order[k].first != order[k - 1].first) mesh.vertices.push_back(soup.vertices[static_cast<std::size_t>(order[k].second)]);
    place[static_cast<std::size_t>(order[k].second)] = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  }
  for (const Triangle& t : soup.triangles) {
    const Triangle moved{place[static_cast<std::size_t>(t[0])], place[static_cast<std::size_t>(t[1])], place[static_cast<std::size_t>(t[2])]};
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) mesh.triangles.push_back(moved);
  }
  return mesh;
}

/// One closed, manifold surface that crosses itself nowhere, every vertex in use.
bool is_sound(const TriangleMesh& mesh) {
  if (mesh.triangles.size() > kMostAsIs) return false;
  const MeshTopology topology = examine_topology(mesh);
  if (!topology.closed || topology.components != 1 || 2 * (static_cast<int>(mesh.vertices.size()) - topology.euler_characteristic) != static_cast<int>(mesh.triangles.size())) return false;
  return count_self_intersections(mesh, 1) == 0;
}

/// The border moved onto the triangles it was made of. Where they are a sheet or a wall thinner than kLeastThickness, it stays outside of them by
/// half of what is missing: thickness is measured between the nearest triangles of the border's two sides.
void draw_back(const TriangleMesh& soup, double voxel_m, TriangleMesh& border) {
  const TriangleTree tree(soup), border_tree(border);
  const auto normals = vertex_normals(border);
  const double reach = kReach * voxel_m;
  std::vector<Vector3d> wanted = border.vertices;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto nearest = tree.closest(border.vertices[i], reach);
    if (nearest.triangle < 0) continue;
    wanted[i] = nearest.point;
    const Vector3d inside = border.vertices[i] - reach * normals[i];
    const auto exit = border_tree.crossing_along(inside, -normals[i], reach);
    if (!exit) continue;  // thick here
    const auto opposite = tree.closest(inside - *exit * normals[i], reach);
    if (opposite.triangle < 0) continue;
    const double thickness = (nearest.point - opposite.point).dot(normals[i]);
    wanted[i] += 0.5 * std::max(0.0, kLeastThickness * voxel_m - thickness) * normals[i];
  }
  border.vertices = approach_without_crossing(border.vertices, wanted, border.triangles).vertices;
}

}  // namespace

Result<TriangleMesh> close_surface(const TriangleMesh& soup, const CloseSurfaceOptions& options) {
  if (soup.triangles.empty()) return failure(ErrorCode::kDegenerateGeometry, "the mesh has no triangles");
  Bounds box;
  for (const Triangle& t : soup.triangles)
    for (const auto v : t) box.include(soup.vertices[static_cast<std::size_t>(v)]);
  const double longest = box.size().maxCoeff();
  if (!(longest > 0) || !std::isfinite(longest)) return failure(ErrorCode::kDegenerateGeometry, "longest side = " + std::to_string(longest) + " m, expected above 0");
  TriangleMesh mesh = welded(soup, box.low, kWeldShare * longest);
  if (options.as_is && is_sound(mesh) && std::abs(signed_volume(mesh)) > 0) {
    if (signed_volume(mesh) < 0)
      for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return simplified(mesh, options.vertices);
  }
  const double voxel_m = longest / options.voxels;
  const auto solid = fill_solid(mesh, voxel_m, true);
  if (!solid) return tl::unexpected(solid.error());
  const TriangleMesh extracted = extract_border(solid->material);
  if (extracted.triangles.empty()) return failure(ErrorCode::kDegenerateGeometry, "nothing solid is left of the mesh");
  auto border = simplified(extracted, options.vertices);
  if (border) draw_back(mesh, voxel_m, *border);
  return border;
}

}  // namespace gfp
