#include "cli/side_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/mesh.hpp"

namespace gfp {
namespace {

constexpr double kTurnRad = std::numbers::pi / 3;
constexpr double kHalfFieldOfViewRad = 0.35;

/// Smallest box around everything to be shown, camera frame.
Bounds shown(const Scene& scene) {
  Bounds box;
  for (const SceneObject& object : scene.objects)
    for (const Eigen::Vector3d& vertex : object.model.vertices) box.include(object.model.T_camera_object * vertex);
  if (scene.objects.empty() && scene.support)
    for (const Eigen::Vector2d& xy : scene.support->polygon) box.include(scene.support->T_camera_support * Eigen::Vector3d(xy.x(), xy.y(), 0));
  if (box.low.x() > box.high.x()) box.include({0, 0, 1});
  return box;
}

/// Looks along `forward` (unit) with the horizon level.
Eigen::Matrix3d level_rotation(const Eigen::Vector3d& forward, const Eigen::Vector3d& up) {
  Eigen::Matrix3d R_camera_view;
  R_camera_view.col(0) = forward.cross(up).normalized();
  R_camera_view.col(1) = forward.cross(R_camera_view.col(0));
  R_camera_view.col(2) = forward;
  return R_camera_view;
}

/// The real camera's direction to the target, turned about `up` and brought to a useful elevation.
Eigen::Vector3d turned_direction(const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  Eigen::Vector3d level = target - up.dot(target) * up;
  if (level.norm() < 1e-6) level = orthonormal_basis(up).first;
  level = rotation_from_vector(kTurnRad * up) * level.normalized();
  const double elevation = std::clamp(std::asin(std::clamp(-up.dot(target.normalized()), -1.0, 1.0)), 0.26, 0.79);
  return std::cos(elevation) * level - std::sin(elevation) * up;
}

}  // namespace

SideView side_view(const Scene& scene, int side_px) {
  const Bounds box = shown(scene);
  const Eigen::Vector3d up = scene.support ? Eigen::Vector3d(scene.support->T_camera_support.linear().col(2)) : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  SideView view;
  view.target_camera = box.centre();
  view.radius_m = std::clamp(0.55 * box.size().norm(), 0.08, 2.0);
  const double focal_px = 0.5 * side_px / std::tan(kHalfFieldOfViewRad);
  view.camera = {side_px, side_px, focal_px, focal_px, 0.5 * (side_px - 1), 0.5 * (side_px - 1), DistortionModel::kNone, {}};
  Transform T_camera_view = Transform::Identity();
  const Eigen::Vector3d forward = turned_direction(view.target_camera, up);
  T_camera_view.linear() = level_rotation(forward, up);
  T_camera_view.translation() = view.target_camera - forward * (view.radius_m / std::sin(kHalfFieldOfViewRad));
  view.T_view_camera = T_camera_view.inverse();
  return view;
}

Image<float> draw_points(Canvas& canvas, const Frame& frame, const SideView& view) {
  Image<float> nearest_m(canvas.width(), canvas.height(), 0.0F);
  const bool colored = frame.color.width == frame.camera.width && frame.color.height == frame.camera.height;
  for (int v = 0; v < frame.depth.pixels.height; ++v) {
    for (int u = 0; u < frame.depth.pixels.width; ++u) {
      const double z = frame.depth.scale_m * frame.depth.pixels.at(u, v);
      if (!(z > 0)) continue;
      const Eigen::Vector3d point = frame.camera.ray(u, v) * z;
      if ((point - view.target_camera).norm() > 1.4 * view.radius_m) continue;
      const Eigen::Vector3d seen = view.T_view_camera * point;
      if (seen.z() < 0.05) continue;
      const Eigen::Vector2d pixel = view.camera.project(seen);
      const int pu = static_cast<int>(std::lround(pixel.x())), pv = static_cast<int>(std::lround(pixel.y()));
      for (int y = pv; y < pv + 2; ++y) {
        for (int x = pu; x < pu + 2; ++x) {
          if (!nearest_m.contains(x, y)) continue;
          float& nearest = nearest_m.at(x, y);
          if (nearest > 0 && nearest <= seen.z()) continue;
          nearest = static_cast<float>(seen.z());
          canvas.blend(x, y, colored ? shaded(frame.color.at(u, v), 0.9) : Rgb8{150, 155, 165});
        }
      }
    }
  }
  return nearest_m;
}

}  // namespace gfp
