#include "modelling/surface_targets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gfp/core/raster.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kTargetPixels = 2500;    ///< About so many of the object's pixels are looked at: four a vertex.
constexpr double kReadingsForHalfWeight = 1.5;
constexpr double kLeastSamples = 0.3;     ///< Fewer say nothing of a vertex.
constexpr double kLeastFacing = 0.25;     ///< Cosine between normal and ray below which a difference along the ray says little.
constexpr double kLeastAgreement = 0.35;  ///< Cosine between modelled and observed normal: else another surface.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// What was read at the triangles about one vertex.
struct Reading {
  double weighted_m = 0;  ///< Sum of distances along the normal, each times its barycentric weight.
  double samples = 0;     ///< Sum of those weights.
  double pixels = 0;      ///< The same, in pixels of full resolution.
};

/// A pixel beside the mask's edge mixes two surfaces.
bool inside_mask(const ObjectView& view, int i, int j) {
  if (i < 1 || j < 1 || i + 1 >= view.depth_m.width || j + 1 >= view.depth_m.height) return false;
  return view.evidence.at(i, j) == Evidence::kObject && view.evidence.at(i - 1, j) == Evidence::kObject && view.evidence.at(i + 1, j) == Evidence::kObject &&
         view.evidence.at(i, j - 1) == Evidence::kObject && view.evidence.at(i, j + 1) == Evidence::kObject;
}

void add_readings(const ObjectView& view, const Transform& T_camera_support, const std::vector<Vector3d>& vertices_support, const std::vector<Vector3d>& normals_support,
                  const std::vector<Triangle>& triangles, double gate_m, std::vector<Reading>& readings) {
  const std::vector<Vector3d> vertices = transformed(vertices_support, T_camera_support);
  std::vector<Vector3d> normals;
  normals.reserve(normals_support.size());
  for (const Vector3d& normal : normals_support) normals.emplace_back(T_camera_support.linear() * normal);
  const int step = std::max(1, static_cast<int>(std::lround(std::sqrt(view.object_pixels / kTargetPixels))));
  DepthTile rendered;
  rendered.reset(view.tile, step);
  rasterise(vertices, triangles, view.camera, rendered, {.cull_back = true});
  for (int cell = 0; cell < rendered.width * rendered.height; ++cell) {
    if (!rendered.hit(cell)) continue;
    const int i = cell % rendered.width * step, j = cell / rendered.width * step;
    if (!inside_mask(view, i, j)) continue;
    const double difference = static_cast<double>(view.depth_m.at(i, j)) - static_cast<double>(rendered.depth[at(cell)]);
    const Vector3d ray = view.camera.ray(view.tile.u0 + i, view.tile.v0 + j);
    const Triangle& t = triangles[at(rendered.triangle[at(cell)])];
    const Vector3d weights = barycentric_on_ray(vertices[at(t[0])], vertices[at(t[1])], vertices[at(t[2])], ray);
    const Vector3d normal = (weights[0] * normals[at(t[0])] + weights[1] * normals[at(t[1])] + weights[2] * normals[at(t[2])]).normalized();
    const double facing = normal.dot(ray);
    if (facing > -kLeastFacing) continue;
    const Vector3d observed = view.normals.at(i, j).cast<double>();
    if (observed.squaredNorm() > 0.5 && observed.dot(normal) < kLeastAgreement) continue;
    const double along_normal = difference * facing;
    if (std::abs(along_normal) > gate_m) continue;
    for (int k = 0; k < 3; ++k) {
      Reading& reading = readings[at(t[at(k)])];
      reading.weighted_m += weights[k] * along_normal;
      reading.samples += weights[k];
      reading.pixels += weights[k] * (step * step);
    }
  }
}

}  // namespace

SurfaceTargets surface_targets(const ObjectView& view, const std::vector<Vector3d>& vertices_support, const std::vector<Vector3d>& normals_support,
                               const std::vector<Triangle>& triangles, double gate_m) {
  std::vector<Reading> readings(vertices_support.size());
  add_readings(view, view.T_camera_support, vertices_support, normals_support, triangles, gate_m, readings);
  for (const Sighting& sighting : view.field)
    add_readings(*sighting.view, sighting.T_sighting_camera * view.T_camera_support, vertices_support, normals_support, triangles, gate_m, readings);
  SurfaceTargets targets;
  targets.distance_m.assign(readings.size(), 0);
  targets.weight.assign(readings.size(), 0);
  targets.readings.assign(readings.size(), 0);
  for (std::size_t v = 0; v < readings.size(); ++v) {
    const Reading& reading = readings[v];
    targets.readings[v] = reading.pixels;
    if (reading.samples < kLeastSamples) continue;
    targets.distance_m[v] = reading.weighted_m / reading.samples;
    targets.weight[v] = reading.samples / (reading.samples + kReadingsForHalfWeight);
  }
  return targets;
}

}  // namespace gfp
