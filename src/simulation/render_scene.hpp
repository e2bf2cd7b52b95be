#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gfp/core/raster.hpp"
#include "gfp/simulation/virtual_scene.hpp"

namespace gfp {

/// What the noise model and the shading need to know of one triangle (or of one of the scene's planes).
struct Facet {
  float plane_distance_m = 0;           ///< Of its plane from the camera: divided by the range it is the cosine of the viewing angle.
  std::int32_t label = -1;              ///< As in FrameTruth.
  Rgb8 color;
  std::array<float, 3> brightness{};    ///< At its three corners.
  std::array<std::int32_t, 3> corner{-1, -1, -1};  ///< Into Rendering::vertices_camera; -1: one brightness all over.
};

/// The scene as a perfect pinhole camera sees it.
struct Rendering {
  DepthTile tile;              ///< All pixels; `triangle` is an index into facets, -1 where nothing is hit.
  std::vector<Facet> facets;   ///< Floor, wall, table, then the objects' triangles.
  std::vector<Eigen::Vector3d> vertices_camera;
};

/// `rendering` may be used again from frame to frame: what it holds is replaced, its memory is kept.
void render_scene(const VirtualScene& scene, const CameraModel& camera, const Transform& T_world_camera, Rendering& rendering);

/// No surface is farther: beyond it a structured-light camera has no reading.
inline constexpr double kFarthest_m = 6.5;

}  // namespace gfp
