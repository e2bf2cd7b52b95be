#include "gfp/modelling/evaluate_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gfp/core/closest_point.hpp"
#include "gfp/core/mesh.hpp"
#include "gfp/core/nearest_cell.hpp"
#include "gfp/core/raster.hpp"
#include "gfp/memory/image_score.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr int kEvidenceCells = 1600;      ///< Object cells on which a fit is judged.
constexpr double kSelfHiddenM = 0.004;    ///< A vertex this far behind the rendered surface is hidden by it.
constexpr double kOnDataSigmas = 3;       ///< Observed: data within so many sigmas of noise plus 3 mm.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

DepthTile render(const ObservedTile& tile, const std::vector<Vector3d>& vertices_camera, const std::vector<Triangle>& triangles) {
  DepthTile rendered;
  rendered.reset(tile.rect, tile.step);
  rasterise(vertices_camera, triangles, tile.camera, rendered, {.cull_back = true});
  return rendered;
}

/// P28 over the object's cells. The nearest surface is looked for among the triangles seen in the 3 x 3 cells around (around the
/// nearest covered cell where the object is bare), so the distance is never underestimated.
double fit_similarity(const ObservedTile& tile, const DepthTile& rendered, const std::vector<Vector3d>& vertices_camera,
                      const std::vector<Triangle>& triangles) {
  const bool seen = std::any_of(rendered.triangle.begin(), rendered.triangle.end(), [](std::int32_t t) { return t >= 0; });
  if (!seen) return 0;  // else every cell would look through the whole tile
  const int reach = std::max(tile.width, tile.height);
  double sum = 0;
  for (const int cell : tile.object_cells) {
    const int centre = nearest_cell(tile.width, tile.height, cell, reach, [&](int c) { return rendered.hit(c); });
    if (centre < 0) continue;
    const Vector3d point = tile.T_camera_support * tile.points[at(cell)];
    double best = 1e300;
    std::int32_t last = -1;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const int u = centre % tile.width + du, v = centre / tile.width + dv;
        if (u < 0 || v < 0 || u >= tile.width || v >= tile.height) continue;
        const std::int32_t index = rendered.triangle[at(v * tile.width + u)];
        if (index < 0 || index == last) continue;
        last = index;
        const Triangle& t = triangles[at(index)];
        best = std::min(best, (closest_point_on_triangle(point, vertices_camera[at(t[0])], vertices_camera[at(t[1])], vertices_camera[at(t[2])]) - point).squaredNorm());
      }
    }
    sum += 1.0 / (1.0 + kFitGammaPerM2 * best);
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, tile.object_cells.size()));
}

/// How deep a point lies inside a convex counter-clockwise outline; <= 0 outside.
double depth_inside(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
  if (outline.size() < 3) return 0;
  double depth = 1e300;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d edge = outline[(k + 1) % outline.size()] - outline[k], to_point = p - outline[k];
    const double length = edge.norm();
    if (length > 1e-9) depth = std::min(depth, (edge.x() * to_point.y() - edge.y() * to_point.x()) / length);
  }
  return depth;
}

/// Of points above the ground, the depth of the deepest; 0 where none is inside.
double deepest_inside(const std::vector<Eigen::Vector2d>& outline, const std::vector<Vector3d>& points) {
  Eigen::AlignedBox2d box;
  for (const auto& corner : outline) box.extend(corner);
  double deepest = 0;
  for (const Vector3d& p : points)
    if (box.contains(p.head<2>())) deepest = std::max(deepest, depth_inside(outline, p.head<2>()));
  return deepest;
}

void mark_observed(const ObservedTile& tile, const DepthTile& rendered, const std::vector<Vector3d>& vertices_camera, std::vector<std::uint8_t>& states) {
  for (std::size_t i = 0; i < vertices_camera.size(); ++i) {
    const Vector3d& p = vertices_camera[i];
    if (p.z() <= 0) continue;
    const Eigen::Vector2d pixel = tile.camera.project(p);
    const int u = static_cast<int>(std::lround((pixel.x() - tile.rect.u0) / tile.step)), v = static_cast<int>(std::lround((pixel.y() - tile.rect.v0) / tile.step));
    // On a silhouette the vertex' own cell may just miss the object: any of the 3 x 3 cells may witness it.
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        if (u + du < 0 || v + dv < 0 || u + du >= tile.width || v + dv >= tile.height) continue;
        const int cell = (v + dv) * tile.width + u + du;
        if (tile.evidence[at(cell)] != Evidence::kObject || !rendered.hit(cell)) continue;
        if (p.z() > static_cast<double>(rendered.depth[at(cell)]) + kSelfHiddenM) continue;
        const double distance = (p.z() - static_cast<double>(tile.depth[at(cell)])) * static_cast<double>(tile.cosine[at(cell)]);
        if (std::abs(distance) < kOnDataSigmas * static_cast<double>(tile.sigma_m[at(cell)]) + 0.003) states[i] |= kVertexObserved;
      }
    }
  }
}

/// What one of the views says, in FitEvidence's terms; marks the vertices that it shows.
FitEvidence evaluate_tile(const ObservedTile& tile, const std::vector<Vector3d>& vertices_support, const std::vector<Triangle>& triangles,
                          std::vector<std::uint8_t>& states) {
  const std::vector<Vector3d> vertices_camera = transformed(vertices_support, tile.T_camera_support);
  const DepthTile rendered = render(tile, vertices_camera, triangles);
  mark_observed(tile, rendered, vertices_camera, states);
  const ImageScore score = image_score(tile, rendered);
  FitEvidence evidence;
  evidence.rms_m = score.rms_m;
  evidence.explained = score.explained;
  evidence.free_space_violation = score.free_space_violation;
  evidence.silhouette_iou = score.silhouette_iou;
  evidence.cost = score.cost;
  evidence.fit_similarity = fit_similarity(tile, rendered, vertices_camera, triangles);
  return evidence;
}

/// Means over the views, each as heavy as the object's cells in it.
FitEvidence pooled(const std::vector<FitEvidence>& of_views, const std::vector<ObservedTile>& tiles) {
  if (of_views.size() == 1) return of_views.front();
  double cells = 0;
  for (const ObservedTile& tile : tiles) cells += static_cast<double>(tile.object_cells.size());
  FitEvidence mean;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    const FitEvidence& seen = of_views[k];
    const double share = static_cast<double>(tiles[k].object_cells.size()) / std::max(1.0, cells);
    mean.rms_m += share * seen.rms_m * seen.rms_m;
    mean.explained += share * seen.explained;
    mean.free_space_violation += share * seen.free_space_violation;
    mean.silhouette_iou += share * seen.silhouette_iou;
    mean.cost += share * seen.cost;
    mean.fit_similarity += share * seen.fit_similarity;
  }
  mean.rms_m = std::sqrt(mean.rms_m);
  return mean;
}

}  // namespace

FitEvidence evaluate_fit(const ObjectView& view, const std::vector<Vector3d>& vertices_camera, const std::vector<Triangle>& triangles,
                         std::vector<std::uint8_t>& states) {
  const auto vertices = transformed(vertices_camera, view.T_camera_support.inverse());
  states.resize(vertices.size(), 0);
  for (std::uint8_t& state : states) state = static_cast<std::uint8_t>(state & ~kVertexObserved);
  const std::vector<ObservedTile> tiles = observe_field(view, kEvidenceCells);
  std::vector<FitEvidence> of_views;
  for (const ObservedTile& tile : tiles) of_views.push_back(evaluate_tile(tile, vertices, triangles, states));
  FitEvidence evidence = pooled(of_views, tiles);
  if (view.has_support)
    for (const Vector3d& p : vertices) evidence.below_support_m = std::max(evidence.below_support_m, -p.z());
  for (const auto& outline : view.neighbour_footprints) evidence.neighbour_overlap_m = std::max(evidence.neighbour_overlap_m, deepest_inside(outline, vertices));
  return evidence;
}

}  // namespace gfp
