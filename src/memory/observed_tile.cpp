#include "gfp/memory/observed_tile.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr double kLeastCosine = 0.2;  ///< Normals of grazing pixels are too uncertain to trust further.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Beside a silhouette cell the sensor saw something farther, or the table; an occluder or a hole says nothing.
bool sees_past(const ObservedTile& tile, int cell, int neighbour) {
  if (tile.evidence[at(neighbour)] == Evidence::kObject) return false;
  const float behind = tile.depth[at(neighbour)];
  return behind > tile.depth[at(cell)] - 0.005F;  // an occluder would be nearer; no reading is 0
}

void mark_outline(ObservedTile& tile) {
  tile.outline.assign(at(tile.cells()), 0);
  for (const int cell : tile.object_cells) {
    const int i = cell % tile.width, j = cell / tile.width;
    const bool seen_past = (i > 0 && sees_past(tile, cell, cell - 1)) || (i + 1 < tile.width && sees_past(tile, cell, cell + 1)) ||
                           (j > 0 && sees_past(tile, cell, cell - tile.width)) || (j + 1 < tile.height && sees_past(tile, cell, cell + tile.width));
    tile.outline[at(cell)] = seen_past ? 1 : 0;
  }
}

}  // namespace

std::vector<std::int32_t> nearest_seed(const std::vector<std::uint8_t>& seed, int width, int height) {
  std::vector<std::int32_t> nearest(seed.size(), -1);
  for (std::size_t c = 0; c < seed.size(); ++c)
    if (seed[c]) nearest[c] = static_cast<std::int32_t>(c);
  const auto squared_distance = [width](int cell, int other) {
    const int du = cell % width - other % width, dv = cell / width - other / width;
    return du * du + dv * dv;
  };
  const auto adopt = [&](int cell, int i, int j) {
    if (i < 0 || j < 0 || i >= width || j >= height) return;
    const auto candidate = nearest[at(j * width + i)];
    auto& mine = nearest[at(cell)];
    if (candidate >= 0 && (mine < 0 || squared_distance(cell, candidate) < squared_distance(cell, mine))) mine = candidate;
  };
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const int cell = j * width + i;
      adopt(cell, i - 1, j); adopt(cell, i, j - 1); adopt(cell, i - 1, j - 1); adopt(cell, i + 1, j - 1);
    }
    for (int i = width - 1; i >= 0; --i) adopt(j * width + i, i + 1, j);
  }
  for (int j = height - 1; j >= 0; --j) {
    for (int i = width - 1; i >= 0; --i) {
      const int cell = j * width + i;
      adopt(cell, i + 1, j); adopt(cell, i, j + 1); adopt(cell, i + 1, j + 1); adopt(cell, i - 1, j + 1);
    }
    for (int i = 0; i < width; ++i) adopt(j * width + i, i - 1, j);
  }
  return nearest;
}

ObservedTile observe(const ObjectView& view, int target_cells) {
  ObservedTile tile;
  tile.camera = view.camera;
  tile.T_camera_support = view.T_camera_support;
  tile.rect = view.tile;
  tile.step = std::max(1, static_cast<int>(std::floor(std::sqrt(view.object_pixels / std::max(1.0, static_cast<double>(target_cells))))));
  tile.width = (view.tile.width() + tile.step - 1) / tile.step;
  tile.height = (view.tile.height() + tile.step - 1) / tile.step;
  const Transform T_support_camera = view.T_camera_support.inverse();
  const std::size_t cells = at(tile.cells());
  tile.depth.assign(cells, 0);
  tile.evidence.assign(cells, Evidence::kUnknown);
  tile.points.assign(cells, Eigen::Vector3d::Zero());
  tile.normals.assign(cells, Eigen::Vector3d::Zero());
  tile.rays.resize(cells);
  tile.cosine.assign(cells, 1.0F);
  tile.sigma_m.assign(cells, 0);
  std::vector<std::uint8_t> is_object(cells, 0);
  for (int cell = 0; cell < tile.cells(); ++cell) {
    const int i = cell % tile.width * tile.step, j = cell / tile.width * tile.step;
    const float z = view.depth_m.at(i, j);
    tile.rays[at(cell)] = T_support_camera.linear() * view.camera.ray(view.tile.u0 + i, view.tile.v0 + j);
    tile.depth[at(cell)] = z;
    tile.evidence[at(cell)] = view.evidence.at(i, j);
    if (view.evidence.at(i, j) != Evidence::kObject || !(z > 0)) continue;
    tile.object_cells.push_back(cell);
    is_object[at(cell)] = 1;
    tile.sigma_m[at(cell)] = static_cast<float>(view.noise.sigma_m(z));
    tile.points[at(cell)] = T_support_camera.translation() + tile.rays[at(cell)] * static_cast<double>(z);
    tile.normals[at(cell)] = T_support_camera.linear() * view.normals.at(i, j).cast<double>();
    const double cosine = std::abs(tile.normals[at(cell)].dot(tile.rays[at(cell)]));
    if (tile.normals[at(cell)].squaredNorm() > 0.5) tile.cosine[at(cell)] = static_cast<float>(std::max(kLeastCosine, cosine));
  }
  tile.nearest_object = nearest_seed(is_object, tile.width, tile.height);
  mark_outline(tile);
  return tile;
}

}  // namespace gfp
