#pragma once

#include <limits>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/core/random.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp::test {

/// A flat-faced block, seen head-on: the pixels `rect` at `depth_m`.
struct Block {
  PixelRect rect;
  double depth_m = 0.8;
  int support = 0;
};

/// A wall-like support at `plane_depth_m` with blocks before it, already segmented: the smallest thing with pixels, depths and labels.
struct BlockScene {
  Frame frame;
  OrganizedCloud cloud;
  NormalMap normals;
  Segments segments;
};

inline void set_point(OrganizedCloud& cloud, int u, int v, double depth_m) {
  const Eigen::Vector3d point = cloud.camera.ray(u, v) * depth_m;
  const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width) + static_cast<std::size_t>(u);
  cloud.x[i] = static_cast<float>(point.x());
  cloud.y[i] = static_cast<float>(point.y());
  cloud.z[i] = static_cast<float>(point.z());
}

/// `noise_seed` 0: no noise; else readings vary by the sensor's own sigma.
inline BlockScene block_scene(const std::vector<Block>& blocks, std::uint64_t noise_seed = 0, int width = 160, int height = 120,
                              double plane_depth_m = 1.0) {
  BlockScene scene;
  scene.frame.sensor = "blocks";
  scene.frame.camera = default_kinect_camera(width, height);
  scene.cloud = {width, height, {}, {}, {}, scene.frame.camera};
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (auto* plane : {&scene.cloud.x, &scene.cloud.y, &scene.cloud.z}) plane->assign(pixels, std::numeric_limits<float>::quiet_NaN());
  scene.normals = {width, height, std::vector<float>(pixels, 0.0F), std::vector<float>(pixels, 0.0F), std::vector<float>(pixels, -1.0F)};
  scene.segments.width = width;
  scene.segments.height = height;
  scene.segments.labels = Image<std::int32_t>(width, height, Segments::kPlaneLabel);

  SupportPlane plane;  // z of the support frame towards the camera
  plane.T_camera_support.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  plane.T_camera_support.translation() = Eigen::Vector3d(0, 0, plane_depth_m);
  scene.segments.planes = {plane};

  Random random(noise_seed);
  const auto reading = [&](double depth_m) {
    return noise_seed == 0 ? depth_m : depth_m + scene.frame.noise.sigma_m(depth_m) * random.normal();
  };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) set_point(scene.cloud, u, v, reading(plane_depth_m));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Segment segment;
    segment.bbox = blocks[b].rect;
    segment.support = blocks[b].support;
    segment.height_m = plane_depth_m - blocks[b].depth_m;
    for (int v = segment.bbox.v0; v < segment.bbox.v1; ++v) {
      for (int u = segment.bbox.u0; u < segment.bbox.u1; ++u) {
        set_point(scene.cloud, u, v, reading(blocks[b].depth_m));
        scene.segments.labels.at(u, v) = static_cast<std::int32_t>(b);
        segment.pixels.push_back(v * width + u);
      }
    }
    scene.segments.segments.push_back(segment);
  }
  return scene;
}

}  // namespace gfp::test
