#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gfp/core/raster.hpp"
#include "gfp/memory/object_view.hpp"

namespace gfp {

/// An ObjectView on a coarser grid, in the support frame, with what image-space fitting asks again and again.
/// Grid cell (i, j) is image pixel (rect.u0 + i * step, rect.v0 + j * step): the grid of a DepthTile.
struct ObservedTile {
  CameraModel camera;
  Transform T_camera_support = Transform::Identity();
  PixelRect rect;
  int step = 1;
  int width = 0, height = 0;
  std::vector<float> depth;                  ///< z in metres, 0 where there is no reading.
  std::vector<Evidence> evidence;
  std::vector<Eigen::Vector3d> points;       ///< Support frame; kObject cells only, else zero.
  std::vector<Eigen::Vector3d> normals;      ///< Support frame, unit; zero where there is none.
  std::vector<Eigen::Vector3d> rays;         ///< Support frame: direction through the cell, z = 1 in the camera.
  std::vector<float> cosine;                 ///< |normal . ray| at object cells, >= 0.2: turns depth differences into plane distances.
  std::vector<float> sigma_m;                ///< Of the reading along the ray.
  std::vector<std::int32_t> object_cells;    ///< Ascending.

  int cells() const { return width * height; }
  double pixel_m(int cell) const { return step * static_cast<double>(depth[static_cast<std::size_t>(cell)]) / camera.fx; }
};

/// `target_cells`: about how many object cells the grid should have; the step follows.
ObservedTile observe(const ObjectView& view, int target_cells);

/// The view and every sighting of its field, each on a grid of its own, all in the support frame of the view.
std::vector<ObservedTile> observe_field(const ObjectView& view, int target_cells);

}  // namespace gfp
