#include "gfp/memory/observed_tile.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr double kLeastCosine = 0.2;  ///< Normals of grazing pixels are too uncertain to trust further.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

std::vector<std::int32_t> nearest_seed(const std::vector<std::uint8_t>& seed, int width, int height) {
  // Offsets to the nearest seed known so far, in a frame of cells that know none; two passes hand them on.
  constexpr std::int16_t kFar = 16000;
  struct Offset {
    std::int16_t du = kFar, dv = kFar;
    std::int32_t squared() const { return du * du + dv * dv; }
  };
  const int pitch = width + 2;
  std::vector<Offset> offsets(at(pitch * (height + 2)));
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      if (seed[at(j * width + i)]) offsets[at((j + 1) * pitch + i + 1)] = {0, 0};
  const auto adopt = [&](Offset& mine, const Offset& theirs, int du, int dv) {
    const Offset candidate{static_cast<std::int16_t>(theirs.du + du), static_cast<std::int16_t>(theirs.dv + dv)};
    if (theirs.du != kFar && (mine.du == kFar || candidate.squared() < mine.squared())) mine = candidate;
  };
  for (int j = 1; j <= height; ++j) {
    Offset* row = &offsets[at(j * pitch)];
    for (int i = 1; i <= width; ++i) {
      Offset& mine = row[i];
      adopt(mine, row[i - 1], -1, 0);
      adopt(mine, row[i - pitch], 0, -1);
      adopt(mine, row[i - pitch - 1], -1, -1);
      adopt(mine, row[i - pitch + 1], 1, -1);
    }
    for (int i = width; i >= 1; --i) adopt(row[i], row[i + 1], 1, 0);
  }
  for (int j = height; j >= 1; --j) {
    Offset* row = &offsets[at(j * pitch)];
    for (int i = width; i >= 1; --i) {
      Offset& mine = row[i];
      adopt(mine, row[i + 1], 1, 0);
      adopt(mine, row[i + pitch], 0, 1);
      adopt(mine, row[i + pitch + 1], 1, 1);
      adopt(mine, row[i + pitch - 1], -1, 1);
    }
    for (int i = 1; i <= width; ++i) adopt(row[i], row[i - 1], -1, 0);
  }
  std::vector<std::int32_t> nearest(seed.size(), -1);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const Offset& offset = offsets[at((j + 1) * pitch + i + 1)];
      if (offset.du != kFar) nearest[at(j * width + i)] = (j + offset.dv) * width + i + offset.du;
    }
  }
  return nearest;
}

ObservedTile observe(const ObjectView& view, int target_cells) {
  ObservedTile tile;
  tile.camera = view.camera;
  tile.T_camera_support = view.T_camera_support;
  tile.rect = view.tile;
  tile.step = std::max(1, static_cast<int>(std::lround(std::sqrt(view.object_pixels / std::max(1.0, static_cast<double>(target_cells))))));
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
  for (int cell = 0; cell < tile.cells(); ++cell) {
    const int i = cell % tile.width * tile.step, j = cell / tile.width * tile.step;
    const float z = view.depth_m.at(i, j);
    tile.rays[at(cell)] = T_support_camera.linear() * view.camera.ray(view.tile.u0 + i, view.tile.v0 + j);
    tile.depth[at(cell)] = z;
    tile.evidence[at(cell)] = view.evidence.at(i, j);
    if (view.evidence.at(i, j) != Evidence::kObject || !(z > 0)) continue;
    tile.object_cells.push_back(cell);
    tile.sigma_m[at(cell)] = static_cast<float>(view.noise.sigma_m(z));
    tile.points[at(cell)] = T_support_camera.translation() + tile.rays[at(cell)] * static_cast<double>(z);
    tile.normals[at(cell)] = T_support_camera.linear() * view.normals.at(i, j).cast<double>();
    const double cosine = std::abs(tile.normals[at(cell)].dot(tile.rays[at(cell)]));
    if (tile.normals[at(cell)].squaredNorm() > 0.5) tile.cosine[at(cell)] = static_cast<float>(std::max(kLeastCosine, cosine));
  }
  return tile;
}

}  // namespace gfp
