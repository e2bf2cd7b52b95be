#include "modelling/seen_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gfp/core/mesh.hpp"
#include "gfp/core/spread_directions.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kStepBehind = 0.012;  ///< Metres of depth between an outline and what is seen beside it. Less may be contact.

constexpr int kHullDirections = 600;
constexpr double kHullSpacing = 0.03;    ///< Radians: half the angle between directions, by which a plane may miss its face.
constexpr double kHullTolerance = 0.004; ///< Metres.

struct Pixel {
  int i, j;
};

/// Where the outline runs between an object pixel and a neighbour behind which the sensor saw on; half pixels.
struct OutlinePoint {
  double u, v;
};

/// Is the pixel's neighbour something that the sensor saw past the object's edge?
bool seen_past(const ObjectView& view, const Pixel& own, const Pixel& beside) {
  if (!view.evidence.contains(beside.i, beside.j)) return false;
  const Evidence label = view.evidence.at(beside.i, beside.j);
  if (label == Evidence::kObject || label == Evidence::kUnknown) return false;
  return view.depth_m.at(beside.i, beside.j) > view.depth_m.at(own.i, own.j) + kStepBehind;
}

/// `count` of `all`, evenly spread over their order.
template <class T>
std::vector<T> every_nth(const std::vector<T>& all, int count) {
  const auto wanted = static_cast<std::size_t>(std::max(count, 1));
  if (all.size() <= wanted) return all;
  std::vector<T> some;
  some.reserve(wanted);
  for (std::size_t k = 0; k < wanted; ++k) some.push_back(all[(2 * k + 1) * all.size() / (2 * wanted)]);
  return some;
}

}  // namespace

std::vector<Vector3d> near_side_of_hull(const std::vector<Vector3d>& points, const Vector3d& eye) {
  std::vector<double> depth(points.size(), std::numeric_limits<double>::infinity());
  std::vector<double> along(points.size());
  for (const auto& n : spread_directions(kHullDirections)) {
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < points.size(); ++k) farthest = std::max(farthest, along[k] = n.dot(points[k]));
    if (n.dot(eye) < farthest) continue;  // the eye does not see this side
    for (std::size_t k = 0; k < points.size(); ++k) depth[k] = std::min(depth[k], farthest - along[k]);
  }
  const double size = bounds(points).size().norm();
  std::vector<Vector3d> outer;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (depth[k] < kHullTolerance + kHullSpacing * size) outer.push_back(points[k]);
  return outer;
}

SeenSurface collect_seen_surface(const ObjectView& view, int max_points, int max_tangents) {
  std::vector<Pixel> mask;
  std::vector<OutlinePoint> outline;
  for (int j = 0; j < view.depth_m.height; ++j)
    for (int i = 0; i < view.depth_m.width; ++i) {
      const float z = view.depth_m.at(i, j);
      if (view.evidence.at(i, j) != Evidence::kObject || !(z > 0) || !std::isfinite(z)) continue;
      mask.push_back({i, j});
      for (const Pixel& beside : {Pixel{i - 1, j}, Pixel{i + 1, j}, Pixel{i, j - 1}, Pixel{i, j + 1}})
        if (seen_past(view, {i, j}, beside))
          outline.push_back({view.tile.u0 + 0.5 * (i + beside.i), view.tile.v0 + 0.5 * (j + beside.j)});
    }
  SeenSurface seen;
  if (mask.empty()) return seen;
  const Transform T_support_camera = view.T_camera_support.inverse();
  double depth = 0;
  const auto chosen = every_nth(mask, max_points);
  for (const auto& [i, j] : chosen) {
    const double z = view.depth_m.at(i, j);
    depth += z / static_cast<double>(chosen.size());
    seen.points.push_back(T_support_camera * (view.camera.ray(view.tile.u0 + i, view.tile.v0 + j) * z));
  }
  for (const auto& [u, v] : every_nth(outline, max_tangents))
    seen.tangents.push_back({T_support_camera.translation(), (T_support_camera.linear() * view.camera.ray(u, v)).normalized()});
  seen.eye = T_support_camera.translation();
  seen.outer_points = near_side_of_hull(seen.points, seen.eye);
  seen.sigma_m = view.noise.sigma_m(depth);
  seen.pixel_m = depth / view.camera.fx;
  return seen;
}

}  // namespace gfp
