#include "gfp/simulation/virtual_camera.hpp"

#include <cmath>

#include "simulation/render_scene.hpp"
#include "simulation/shade.hpp"
#include "simulation/structured_light.hpp"

namespace gfp {
namespace {

FrameTruth make_truth(const VirtualScene& scene, const Rendering& rendering, const Transform& T_world_camera) {
  FrameTruth truth;
  const DepthTile& tile = rendering.tile;
  truth.labels = Image<std::int32_t>(tile.width, tile.height, -1);
  truth.depth_m = Image<float>(tile.width, tile.height);
  for (std::size_t i = 0; i < tile.triangle.size(); ++i) {
    if (tile.triangle[i] < 0) continue;
    truth.labels.pixels[i] = rendering.facets[static_cast<std::size_t>(tile.triangle[i])].label;
    truth.depth_m.pixels[i] = tile.depth[i];
  }
  truth.T_world_camera = T_world_camera;
  const Transform T_camera_world = T_world_camera.inverse();
  for (const PlacedMesh& object : scene.objects) truth.T_camera_object.push_back(T_camera_world * object.T_world_object);
  return truth;
}

}  // namespace

Capture capture(const VirtualScene& scene, const CameraModel& camera, const Transform& T_world_camera, const VirtualCameraOptions& options,
                std::uint64_t seed) {
  thread_local Rendering rendering;  // megabytes that every frame needs again
  render_scene(scene, camera, T_world_camera, rendering);
  Capture result;
  Frame& frame = result.frame;
  frame.sensor = "synthetic";
  frame.camera = camera;
  frame.noise = options.noise;
  frame.T_world_sensor = T_world_camera;
  const bool perfect = options.noise_scale <= 0;
  frame.depth.scale_m = perfect ? 1e-4 : 1e-3;  // a Kinect delivers whole millimetres
  frame.depth.pixels = perfect ? ideal_depth(rendering, frame.depth.scale_m)
                               : measure_depth(rendering, camera, options, frame.depth.scale_m, seed);
  if (options.color) frame.color = shade(rendering, camera);
  result.truth = make_truth(scene, rendering, T_world_camera);
  return result;
}

Transform look_at_pose(const Eigen::Vector3d& target_world, double distance_m, double elevation_rad, double azimuth_rad) {
  const double ce = std::cos(elevation_rad), se = std::sin(elevation_rad), ca = std::cos(azimuth_rad), sa = std::sin(azimuth_rad);
  const Eigen::Vector3d back(ce * ca, ce * sa, se);  // from the target to the camera
  const Eigen::Vector3d right(-sa, ca, 0);           // level, also straight above the target
  Transform T_world_camera = Transform::Identity();
  T_world_camera.linear().col(0) = right;
  T_world_camera.linear().col(1) = right.cross(back);
  T_world_camera.linear().col(2) = -back;
  T_world_camera.translation() = target_world + distance_m * back;
  return T_world_camera;
}

}  // namespace gfp
