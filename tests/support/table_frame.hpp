#pragma once

#include <cstdint>
#include <vector>

#include "gfp/core/raster.hpp"
#include "gfp/frame/frame.hpp"
#include "support/box_model.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp::test {

/// A box on a table: where, how large, turned by `yaw_rad` about up.
struct TableBox {
  double x_m = 0, y_m = 0;
  Eigen::Vector3d size_m{0.06, 0.06, 0.1};
  double yaw_rad = 0.3;
};

/// A table-top frame without noise, 0.1 mm a unit: a table of 1.2 x 1.0 m, seen from 35 degrees above, with boxes on it; nothing beyond.
inline Frame table_frame(const std::vector<TableBox>& boxes, const CameraModel& camera = default_kinect_camera(), double distance_m = 0.9) {
  const Transform T_camera_world = look_at({0, 0, 0}, distance_m, 0.61, -1.57).inverse();
  DepthTile picture;
  picture.reset({0, 0, camera.width, camera.height}, 1);
  std::vector<TriangleMesh> meshes{{{{-0.6, -0.5, 0}, {0.6, -0.5, 0}, {0.6, 0.5, 0}, {-0.6, 0.5, 0}}, {{0, 1, 2}, {0, 2, 3}}}};
  for (const TableBox& box : boxes) {
    Transform T_world_box = Transform::Identity();
    T_world_box.linear() = rotation_from_vector({0, 0, box.yaw_rad});
    T_world_box.translation() = Eigen::Vector3d(box.x_m, box.y_m, 0);
    meshes.push_back(transformed(box_mesh(box.size_m), T_world_box));
  }
  for (const TriangleMesh& mesh : meshes) {
    const TriangleMesh seen = transformed(mesh, T_camera_world);
    rasterise(seen.vertices, seen.triangles, camera, picture);
  }
  Frame frame;
  frame.sensor = "table";
  frame.camera = camera;
  frame.depth.scale_m = 1e-4;
  frame.depth.pixels = Image<std::uint16_t>(camera.width, camera.height);
  for (std::size_t i = 0; i < picture.depth.size(); ++i)
    if (picture.triangle[i] >= 0) frame.depth.pixels.pixels[i] = static_cast<std::uint16_t>(1e4 * static_cast<double>(picture.depth[i]) + 0.5);
  return frame;
}

}  // namespace gfp::test
