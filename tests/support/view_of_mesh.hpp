#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"
#include "gfp/core/raster.hpp"
#include "gfp/memory/object_view.hpp"

// What a depth camera sees of a known mesh on a table, as an ObjectView: no segmentation stands between a test and its truth.
// World frame: z up, the table is the disc of radius `table_radius_m` in z = 0; below it a floor, far away a wall.

namespace gfp::test {

struct ViewOfMeshOptions {
  double noise_scale = 0;                   ///< Times SensorNoise{}; 0: a perfect sensor.
  std::uint64_t seed = 1;                   ///< Of the noise.
  int margin_px = 12;                       ///< Of the tile around the mask.
  double table_radius_m = 0.8;
  std::vector<TriangleMesh> others_world{}; ///< Neighbours: occluders, footprints, Evidence::kOther.
  bool has_support = true;                  ///< False: the table counts as background, only "up" is known.
};

/// The camera at `distance_m` from `target_world`, `elevation_rad` above the horizon, `azimuth_rad` about z, horizon level.
inline Transform look_at(const Eigen::Vector3d& target_world, double distance_m, double elevation_rad, double azimuth_rad) {
  const Eigen::Vector3d backwards(std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
                                  std::sin(elevation_rad));
  const Eigen::Vector3d right(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0);
  Transform T_world_camera = Transform::Identity();
  T_world_camera.linear().col(0) = right;
  T_world_camera.linear().col(1) = (-backwards).cross(right);
  T_world_camera.linear().col(2) = -backwards;
  T_world_camera.translation() = target_world + distance_m * backwards;
  return T_world_camera;
}

/// Plane fitted to the readings within +-4 pixels that lie within 2 % of the depth; towards the camera; zero where there are too few.
inline Eigen::Vector3f normal_at(const CameraModel& camera, const PixelRect& tile, const Image<float>& depth_m, int i, int j) {
  const double z = depth_m.at(i, j);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  int count = 0;
  const Eigen::Vector3d centre = camera.ray(tile.u0 + i, tile.v0 + j) * z;
  for (int y = std::max(0, j - 4); y <= std::min(depth_m.height - 1, j + 4); ++y)
    for (int x = std::max(0, i - 4); x <= std::min(depth_m.width - 1, i + 4); ++x) {
      const double d = depth_m.at(x, y);
      if (d <= 0 || std::abs(d - z) > 0.02 * z) continue;
      const Eigen::Vector3d p = camera.ray(tile.u0 + x, tile.v0 + y) * d - centre;
      mean += p;
      moment += p * p.transpose();
      ++count;
    }
  if (count < 6) return Eigen::Vector3f::Zero();
  mean /= count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moment / count - mean * mean.transpose());
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (normal.dot(centre) > 0) normal = -normal;
  return normal.cast<float>();
}

/// Convex outline of the vertices' shadows on z = 0, counter-clockwise (Andrew's monotone chain).
inline std::vector<Eigen::Vector2d> footprint(const TriangleMesh& mesh_world) {
  std::vector<Eigen::Vector2d> points, hull;
  for (const auto& v : mesh_world.vertices) points.push_back(v.head<2>());
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= start + 2) {
        const Eigen::Vector2d u = hull.back() - hull[hull.size() - 2], w = p - hull.back();
        if (u.x() * w.y() - u.y() * w.x() > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// Depth and label of what stands behind the objects on the ray through a pixel.
inline std::pair<double, Evidence> surroundings(const Eigen::Vector3d& ray_camera, const Transform& T_world_camera, double table_radius_m) {
  const Eigen::Vector3d origin = T_world_camera.translation(), ray = T_world_camera.linear() * ray_camera;
  const double table = -origin.z() / ray.z();
  if (ray.z() < 0 && (origin + table * ray).head<2>().norm() < table_radius_m) return {table, Evidence::kSupport};
  const double floor = ray.z() < 0 ? (-0.74 - origin.z()) / ray.z() : std::numeric_limits<double>::infinity();
  return {std::min(floor, 3.0), Evidence::kBackground};
}

/// Renders the mesh into an ObjectView with perfect mask, table and camera; only depths carry noise. Deterministic for one seed.
/// Readings of other objects in front of ours set `occluded`. A mesh out of sight gives object_pixels = 0 and a tile of one pixel.
inline ObjectView view_of(const TriangleMesh& mesh_world, const CameraModel& camera, const Transform& T_world_camera,
                          const ViewOfMeshOptions& options = {}) {
  const Transform T_camera_world = T_world_camera.inverse();
  DepthTile picture;
  picture.reset({0, 0, camera.width, camera.height}, 1);
  const TriangleMesh own = transformed(mesh_world, T_camera_world);
  rasterise(own.vertices, own.triangles, camera, picture);
  ObjectView view;
  auto first_other = static_cast<std::int32_t>(own.triangles.size());
  for (const auto& other : options.others_world) {
    const TriangleMesh mesh = transformed(other, T_camera_world);
    rasterise(mesh.vertices, mesh.triangles, camera, picture, {.first_triangle = first_other});
    view.neighbour_footprints.push_back(footprint(other));
  }

  PixelRect mask{camera.width, camera.height, 0, 0};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const auto hit = picture.triangle[static_cast<std::size_t>(v * camera.width + u)];
      if (hit < 0 || hit >= first_other) continue;
      mask = {std::min(mask.u0, u), std::min(mask.v0, v), std::max(mask.u1, u + 1), std::max(mask.v1, v + 1)};
    }
  if (mask.width() <= 0) mask = {0, 0, 1, 1};
  view.tile = {std::max(0, mask.u0 - options.margin_px), std::max(0, mask.v0 - options.margin_px),
               std::min(camera.width, mask.u1 + options.margin_px), std::min(camera.height, mask.v1 + options.margin_px)};
  view.camera = camera;
  view.T_camera_support = T_camera_world;
  view.has_support = options.has_support;
  view.depth_m = Image<float>(view.tile.width(), view.tile.height());
  view.evidence = Image<Evidence>(view.tile.width(), view.tile.height(), Evidence::kUnknown);
  view.normals = Image<Eigen::Vector3f>(view.tile.width(), view.tile.height(), Eigen::Vector3f::Zero());

  Random random(options.seed);
  std::vector<double> heights;
  for (int j = 0; j < view.tile.height(); ++j)
    for (int i = 0; i < view.tile.width(); ++i) {
      const int u = view.tile.u0 + i, v = view.tile.v0 + j;
      const auto cell = static_cast<std::size_t>(v * camera.width + u);
      auto [depth, label] = surroundings(camera.ray(u, v), T_world_camera, options.table_radius_m);
      if (!options.has_support && label == Evidence::kSupport) label = Evidence::kBackground;
      if (picture.triangle[cell] >= 0 && picture.depth[cell] <= depth + 1e-6) {
        depth = picture.depth[cell];
        label = picture.triangle[cell] < first_other ? Evidence::kObject : Evidence::kOther;
      }
      depth += options.noise_scale * view.noise.sigma_m(depth) * random.normal();
      view.depth_m.at(i, j) = static_cast<float>(depth);
      view.evidence.at(i, j) = label;
      if (label != Evidence::kObject) continue;
      ++view.object_pixels;
      heights.push_back((T_world_camera * (camera.ray(u, v) * depth)).z());
      const bool at_border = u == 0 || v == 0 || u == camera.width - 1 || v == camera.height - 1;
      view.touches_border |= at_border;
      view.top_cut |= v == 0;
    }
  for (int j = 0; j < view.tile.height(); ++j)
    for (int i = 0; i < view.tile.width(); ++i) {
      if (view.evidence.at(i, j) != Evidence::kObject) continue;
      view.normals.at(i, j) = normal_at(camera, view.tile, view.depth_m, i, j);
      for (const auto& [x, y] : {std::pair(i - 1, j), {i + 1, j}, {i, j - 1}, {i, j + 1}})
        view.occluded |= view.evidence.contains(x, y) && view.evidence.at(x, y) == Evidence::kOther &&
                         view.depth_m.at(x, y) < view.depth_m.at(i, j);
    }
  if (!heights.empty()) {
    const auto rank = static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(heights.size() - 1));
    std::nth_element(heights.begin(), heights.begin() + rank, heights.end());
    view.height_m = heights[static_cast<std::size_t>(rank)];
  }
  return view;
}

}  // namespace gfp::test
