#include "occluder.hpp"

#include <algorithm>

#include "gfp/core/raster.hpp"

namespace gfp {
namespace {

constexpr double kGap_m = 0.03;    // between box and object: more than segmentation bridges
constexpr double kDepth_m = 0.04;  // of the box along the view
constexpr double kWidth_m = 0.30;

TriangleMesh solid_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back((k & 1) != 0 ? high.x() : low.x(), (k & 2) != 0 ? high.y() : low.y(), (k & 4) != 0 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

PixelRect rect_around(const TriangleMesh& mesh_camera, const CameraModel& camera) {
  PixelRect rect{camera.width, camera.height, 0, 0};
  for (const auto& v : mesh_camera.vertices) {
    const Eigen::Vector2d pixel = camera.project(v).cwiseMax(0.0).cwiseMin(Eigen::Vector2d(camera.width - 2, camera.height - 2));
    rect.u0 = std::min(rect.u0, static_cast<int>(pixel.x()));
    rect.v0 = std::min(rect.v0, static_cast<int>(pixel.y()));
    rect.u1 = std::max(rect.u1, static_cast<int>(pixel.x()) + 2);
    rect.v1 = std::max(rect.v1, static_cast<int>(pixel.y()) + 2);
  }
  return rect;
}

DepthTile draw(const TriangleMesh& mesh_camera, const CameraModel& camera, const PixelRect& rect) {
  DepthTile tile;
  tile.reset(rect, 1);
  rasterise(mesh_camera.vertices, mesh_camera.triangles, camera, tile);
  return tile;
}

double hidden_share(const DepthTile& object, const DepthTile& box) {
  int seen = 0, hidden = 0;
  for (std::size_t i = 0; i < object.depth.size(); ++i) {
    if (object.triangle[i] < 0) continue;
    ++seen;
    hidden += box.depth[i] < object.depth[i] ? 1 : 0;
  }
  return seen > 0 ? static_cast<double>(hidden) / seen : 0.0;
}

}  // namespace

Occluder place_occluder(const PlacedMesh& object, const CameraModel& camera, const Transform& T_world_camera, double share, bool from_left) {
  const TriangleMesh world = transformed(object.mesh, object.T_world_object);
  const Bounds extent = bounds(world.vertices);
  const Transform T_camera_world = T_world_camera.inverse();
  const TriangleMesh seen = transformed(world, T_camera_world);
  const PixelRect rect = rect_around(seen, camera);
  const DepthTile object_tile = draw(seen, camera, rect);
  const auto share_behind = [&](const TriangleMesh& box) { return hidden_share(object_tile, draw(transformed(box, T_camera_world), camera, rect)); };
  const double back = extent.low.y() - kGap_m;
  // Tall enough that the ray to the object's far top passes through its upper edge, but below the camera.
  const Eigen::Vector3d eye = T_world_camera.translation(), far_top(0, extent.high.y(), extent.high.z());
  const double along = (back - far_top.y()) / (eye.y() - far_top.y());
  const double height = std::min(far_top.z() + along * (eye.z() - far_top.z()) + 0.02, eye.z() - 0.1);
  const auto box_with_edge_at = [&](double edge) {
    const double x0 = from_left ? edge - kWidth_m : edge, x1 = from_left ? edge : edge + kWidth_m;
    return solid_box({x0, back - kDepth_m, 0}, {x1, back, std::max(height, 0.02)});
  };
  double outside = from_left ? extent.low.x() - 0.05 : extent.high.x() + 0.05;  // hides nothing
  double inside = from_left ? extent.high.x() + 0.05 : extent.low.x() - 0.05;   // hides most
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (outside + inside);
    const bool enough = share_behind(box_with_edge_at(middle)) >= share;
    (enough ? inside : outside) = middle;
  }
  TriangleMesh box = box_with_edge_at(inside);
  const double hidden = share_behind(box);
  return {{"occluder", "box", std::move(box), Transform::Identity(), {120, 120, 140}}, hidden};
}

}  // namespace gfp
