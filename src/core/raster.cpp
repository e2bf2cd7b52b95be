#include "gfp/core/raster.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace gfp {
namespace {

using Eigen::Vector3d;

struct ImagePoint {
  double i, j;          ///< In cells of the tile.
  double inverse_depth;
};

/// value(i, j) = a i + b j + c, zero on the line through p and q, positive to its left (image y is down: orientation is normalised later).
struct Line {
  double a, b, c;
  double at(int i, int j) const { return a * i + b * j + c; }
};

Line line_through(const ImagePoint& p, const ImagePoint& q) {
  return {p.j - q.j, q.i - p.i, p.i * q.j - p.j * q.i};
}

/// Of a number in [0, 2^31): without SSE 4.1, std::ceil is a call.
int round_up(double value) {
  const int below = static_cast<int>(value);
  return below + (below < value ? 1 : 0);
}

void draw(const ImagePoint (&p)[3], std::int32_t index, DepthTile& tile) {
  const double low_i = std::max(0.0, std::min({p[0].i, p[1].i, p[2].i})), high_i = std::min(tile.width - 1.0, std::max({p[0].i, p[1].i, p[2].i}));
  const double low_j = std::max(0.0, std::min({p[0].j, p[1].j, p[2].j})), high_j = std::min(tile.height - 1.0, std::max({p[0].j, p[1].j, p[2].j}));
  if (!(low_i <= high_i && low_j <= high_j)) return;
  const int i0 = round_up(low_i), i1 = static_cast<int>(high_i), j0 = round_up(low_j), j1 = static_cast<int>(high_j);
  if (i0 > i1 || j0 > j1) return;

  double twice_area = (p[1].i - p[0].i) * (p[2].j - p[0].j) - (p[2].i - p[0].i) * (p[1].j - p[0].j);
  if (std::abs(twice_area) < 1e-12) return;  // seen edge-on
  const double sign = twice_area > 0 ? 1.0 : -1.0;
  twice_area = std::abs(twice_area);
  Line edges[3] = {line_through(p[1], p[2]), line_through(p[2], p[0]), line_through(p[0], p[1])};
  Line inverse_depth{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    edges[k] = {sign * edges[k].a, sign * edges[k].b, sign * edges[k].c};
    const double weight = p[k].inverse_depth / twice_area;
    inverse_depth.a += weight * edges[k].a;
    inverse_depth.b += weight * edges[k].b;
    inverse_depth.c += weight * edges[k].c;
  }
  const double slack = -1e-9 * twice_area;  // shared edges belong to both triangles: no cracks
  const auto put = [&](int i, int j) {
    const double inverse = inverse_depth.a * i + inverse_depth.b * j + inverse_depth.c;
    const auto depth = static_cast<float>(1.0 / inverse);
    const std::size_t cell = static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.width) + static_cast<std::size_t>(i);
    if (depth < tile.depth[cell] && depth > 0) {
      tile.depth[cell] = depth;
      tile.triangle[cell] = index;
    }
  };
  constexpr int kFewColumns = 4;  // there, testing each pixel costs less than the divisions that clip a run
  if (i1 - i0 < kFewColumns) {
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i)
        if (std::min({edges[0].at(i, j), edges[1].at(i, j), edges[2].at(i, j)}) >= slack) put(i, j);
    return;
  }
  for (int j = j0; j <= j1; ++j) {
    // The columns where all three edge functions are non-negative form one run; clip it instead of testing each pixel.
    double low = i0, high = i1;
    for (const Line& e : edges) {
      const double rest = e.b * j + e.c - slack;
      if (e.a > 0) low = std::max(low, -rest / e.a);
      else if (e.a < 0) high = std::min(high, -rest / e.a);
      else if (rest < 0) high = -1;
    }
    if (low > high) continue;
    const int first = round_up(low), last = static_cast<int>(high);
    for (int i = first; i <= last; ++i) put(i, j);
  }
}

}  // namespace

void DepthTile::reset(const PixelRect& new_rect, int new_step) {
  rect = new_rect;
  step = new_step;
  width = std::max(0, (rect.width() + step - 1) / step);
  height = std::max(0, (rect.height() + step - 1) / step);
  const std::size_t cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  depth.assign(cells, std::numeric_limits<float>::infinity());
  triangle.assign(cells, -1);
}

void rasterise(const std::vector<Vector3d>& vertices_camera, const std::vector<Triangle>& triangles, const CameraModel& camera,
               DepthTile& tile, const RasteriseOptions& options) {
  thread_local std::vector<ImagePoint> projected;
  projected.resize(vertices_camera.size());
  const double scale = 1.0 / tile.step;
  for (std::size_t k = 0; k < vertices_camera.size(); ++k) {
    const Vector3d& p = vertices_camera[k];
    const double inverse = 1.0 / p.z();
    projected[k] = {(camera.fx * p.x() * inverse + camera.cx - tile.rect.u0) * scale,
                    (camera.fy * p.y() * inverse + camera.cy - tile.rect.v0) * scale, p.z() < options.near_m ? -1.0 : inverse};
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const ImagePoint corners[3] = {projected[static_cast<std::size_t>(triangles[t][0])], projected[static_cast<std::size_t>(triangles[t][1])],
                                   projected[static_cast<std::size_t>(triangles[t][2])]};
    if (corners[0].inverse_depth < 0 || corners[1].inverse_depth < 0 || corners[2].inverse_depth < 0) continue;
    if (options.cull_back) {
      // Counter-clockwise from outside is clockwise in an image whose y points down.
      const double twice_area = (corners[1].i - corners[0].i) * (corners[2].j - corners[0].j) -
                                (corners[2].i - corners[0].i) * (corners[1].j - corners[0].j);
      if (twice_area > 0) continue;
    }
    draw(corners, options.first_triangle + static_cast<std::int32_t>(t), tile);
  }
}

Vector3d barycentric_on_ray(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& ray) {
  // Signed volumes of the ray with the triangle's edges.
  const Vector3d weights(ray.dot(b.cross(c)), ray.dot(c.cross(a)), ray.dot(a.cross(b)));
  const double sum = weights.sum();
  if (std::abs(sum) < 1e-300) return Vector3d::Constant(1.0 / 3.0);
  return weights / sum;
}

}  // namespace gfp
