#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "gfp/cloud/depth_to_cloud.hpp"
#include "gfp/core/random.hpp"
#include "gfp/core/sensor_noise.hpp"

namespace gfp::test {

/// Boxes, standing cylinders and half planes, seen by a camera that looks down on a table: closed forms, ray by ray.
/// World frame: z up, the table's surface is z = 0; the camera stands at (0, -distance cos, distance sin) and looks at the origin.
struct ToyScene {
  struct Box { Eigen::Vector3d low, high; double yaw_rad = 0; };
  struct Cylinder { Eigen::Vector2d centre; double radius, bottom, top; bool hollow = false; };  ///< Hollow: open at the top, 4 mm of floor.
  std::vector<Box> boxes;
  std::vector<Cylinder> cylinders;
  double table_half_x = 0.5, table_half_y = 0.35, floor_z = -0.75;
  double wall_y = std::numeric_limits<double>::infinity();
  double distance = 0.8, elevation_rad = 0.7;

  Transform T_world_camera() const {
    const Eigen::Vector3d forward(0, std::cos(elevation_rad), -std::sin(elevation_rad)), right(1, 0, 0);
    Transform pose = Transform::Identity();
    pose.linear().col(0) = right;
    pose.linear().col(1) = forward.cross(right);
    pose.linear().col(2) = forward;
    pose.translation() = -distance * forward;
    return pose;
  }

  struct Hit { double depth = std::numeric_limits<double>::infinity(); int label = -1; };

  /// `label`: -1 nothing, -2 table, -3 floor, -4 wall, else index: boxes, then cylinders.
  Hit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    Hit hit;
    const auto take = [&](double depth, int label) { if (depth > 0.01 && depth < hit.depth) hit = {depth, label}; };
    const double table = -origin.z() / ray.z();
    const Eigen::Vector3d on_table = origin + table * ray;
    if (std::abs(on_table.x()) <= table_half_x && std::abs(on_table.y()) <= table_half_y) take(table, -2);
    take((floor_z - origin.z()) / ray.z(), -3);
    if (std::isfinite(wall_y)) take((wall_y - origin.y()) / ray.y(), -4);
    for (std::size_t b = 0; b < boxes.size(); ++b) take(cast_box(boxes[b], origin, ray), static_cast<int>(b));
    for (std::size_t c = 0; c < cylinders.size(); ++c) take(cast_cylinder(cylinders[c], origin, ray), static_cast<int>(boxes.size() + c));
    return hit;
  }

 private:
  static double cast_box(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    const Eigen::Vector3d centre = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    const Eigen::Matrix3d unturn = Eigen::AngleAxisd(-box.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d o = unturn * (origin - centre), d = unturn * ray;
    double enter = -1e9, leave = 1e9;
    for (int k = 0; k < 3; ++k) {
      const double a = (-half[k] - o[k]) / d[k], b = (half[k] - o[k]) / d[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : -1;
  }
  static double cast_cylinder(const Cylinder& cylinder, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    const Eigen::Vector2d o = origin.head<2>() - cylinder.centre, d = ray.head<2>();
    const double top = (cylinder.top - origin.z()) / ray.z();
    const bool enters_top = (o + top * d).norm() <= cylinder.radius;
    if (enters_top && !cylinder.hollow) return top;
    const double a = d.squaredNorm(), b = o.dot(d), square = b * b - a * (o.squaredNorm() - cylinder.radius * cylinder.radius);
    if (square < 0) return -1;
    if (enters_top) {
      const double far_wall = (-b + std::sqrt(square)) / a, floor = (cylinder.bottom + 0.004 - origin.z()) / ray.z();
      return std::min(far_wall, floor);
    }
    const double side = (-b - std::sqrt(square)) / a, z = origin.z() + side * ray.z();
    return z >= cylinder.bottom && z <= cylinder.top ? side : -1;
  }
};

struct ToyView {
  OrganizedCloud cloud;
  Image<std::int32_t> truth;  ///< As ToyScene::Hit::label.
};

/// `noise_scale` times a Kinect's noise; 0: exact.
inline ToyView view(const ToyScene& scene, double noise_scale = 0, std::uint64_t seed = 1, CameraModel camera = default_kinect_camera()) {
  ToyView result{{}, Image<std::int32_t>(camera.width, camera.height, -1)};
  OrganizedCloud& cloud = result.cloud;
  cloud.width = camera.width;
  cloud.height = camera.height;
  cloud.camera = camera;
  const Transform T_world_camera = scene.T_world_camera();
  Random random(seed);
  const SensorNoise noise;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      const auto hit = scene.cast(T_world_camera.translation(), T_world_camera.linear() * ray);
      double z = hit.depth < 6.0 ? hit.depth : std::numeric_limits<double>::quiet_NaN();
      if (noise_scale > 0 && z == z) z += noise_scale * noise.sigma_m(z) * random.normal();
      const Eigen::Vector3f p = (ray * z).cast<float>();
      cloud.x.push_back(p.x());
      cloud.y.push_back(p.y());
      cloud.z.push_back(p.z());
      result.truth.at(u, v) = z == z ? hit.label : -1;
    }
  return result;
}

}  // namespace gfp::test
