#include "gfp/memory/observed_tile.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr double kLeastCosine = 0.2;  ///< Normals of grazing pixels are too uncertain to trust further.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

ObservedTile observe_from(const ObjectView& view, const Transform& T_camera_support, int target_cells) {
  ObservedTile tile;
  tile.camera = view.camera;
  tile.T_camera_support = T_camera_support;
  tile.rect = view.tile;
  tile.step = std::max(1, static_cast<int>(std::lround(std::sqrt(view.object_pixels / std::max(1.0, static_cast<double>(target_cells))))));
  tile.width = (view.tile.width() + tile.step - 1) / tile.step;
  tile.height = (view.tile.height() + tile.step - 1) / tile.step;
  const Transform T_support_camera = T_camera_support.inverse();
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

}  // namespace

ObservedTile observe(const ObjectView& view, int target_cells) { return observe_from(view, view.T_camera_support, target_cells); }

std::vector<ObservedTile> observe_field(const ObjectView& view, int target_cells) {
  std::vector<ObservedTile> tiles{observe(view, target_cells)};
  for (const Sighting& sighting : view.field) tiles.push_back(observe_from(*sighting.view, sighting.T_sighting_camera * view.T_camera_support, target_cells));
  return tiles;
}

}  // namespace gfp
