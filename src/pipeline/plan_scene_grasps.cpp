#include "pipeline/plan_scene_grasps.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "gfp/grasp/clear_of_points.hpp"
#include "gfp/pipeline/stage_timings.hpp"

namespace gfp {
namespace {

/// A ball around the fitted object, camera frame.
Sphere ball_around(const SceneObject& object) {
  const Bounds box = bounds(object.model.vertices);
  return {object.model.T_camera_object * box.centre(), 0.5 * box.size().norm()};
}

/// From an object's surface outwards, a gripper that holds it can touch no more than this.
double reach_m(const PipelineOptions& options) {
  const Gripper& gripper = options.gripper;
  return gripper.finger_length_m + gripper.palm_depth_m + gripper.palm_width_m + options.grasp.pregrasp_offset_m;
}

bool within(const Sphere& a, const Sphere& b, double gap_m) { return (a.centre - b.centre).norm() < a.radius + b.radius + gap_m; }

/// Seen points that belong to no object, one pixel in 4 x 4: cables, hands, rejected clusters, and the surfaces themselves.
struct LoosePoint {
  Eigen::Vector3f point_camera;
  std::int32_t plane;  ///< Index into Segments::planes, -1 where it lies on none.
};

std::vector<LoosePoint> loose_points(const Segments& segments, const OrganizedCloud& cloud) {
  constexpr int kStride = 4;
  std::vector<LoosePoint> points;
  if (segments.planes.empty()) return points;  // the table itself would stand in the way
  for (int v = 0; v < segments.height; v += kStride) {
    for (int u = 0; u < segments.width; u += kStride) {
      const std::size_t pixel = segments.labels.index(u, v);
      const std::int32_t label = segments.labels.pixels[pixel];
      if (label <= Segments::kUnassigned && cloud.valid(pixel))
        points.push_back({cloud.point(pixel), label <= Segments::kPlaneLabel ? Segments::kPlaneLabel - label : -1});
    }
  }
  return points;
}

/// Of the loose points those near the object that stand above what it stands on: a shelf over it is one, the floor under its table is not.
std::vector<Eigen::Vector3f> obstacles_of(const ObjectView& view, const Segments& segments, const std::vector<LoosePoint>& loose, const Sphere& ball, double reach) {
  constexpr double kClearOfPlaneM = 0.015;  // nearer ones may be the surface's own noise
  std::vector<Eigen::Vector3f> points;
  if (!view.has_support) return points;
  const int own = view.segment >= 0 && view.segment < static_cast<int>(segments.segments.size()) ? segments.segments[static_cast<std::size_t>(view.segment)].support : -1;
  const Transform T_support_camera = view.T_camera_support.inverse();
  const Eigen::Vector3f up = T_support_camera.linear().row(2).transpose().cast<float>(), centre = ball.centre.cast<float>();
  const auto least = static_cast<float>(kClearOfPlaneM - T_support_camera.translation().z()), farthest = static_cast<float>(ball.radius + reach);
  for (const LoosePoint& loose_point : loose) {
    const Eigen::Vector3f& p = loose_point.point_camera;
    if (up.dot(p) > least && (p - centre).squaredNorm() < farthest * farthest && (loose_point.plane < 0 || loose_point.plane != own)) points.push_back(p);
  }
  return points;
}

GraspScene surroundings(std::size_t self, const std::vector<SceneObject>& objects, const std::vector<Sphere>& balls, const ObjectView& view, double reach) {
  GraspScene scene;
  scene.has_support = view.has_support;
  scene.T_camera_support = view.T_camera_support;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (i != self && within(balls[i], balls[self], reach)) scene.neighbours.push_back(&objects[i].model);
  return scene;
}

bool changed(const SceneObject& object) { return object.status != ObjectStatus::kUnchanged; }

}  // namespace

void plan_scene_grasps(std::vector<SceneObject>& objects, const std::vector<const ObjectView*>& views, const Segments& segments,
                       const OrganizedCloud& cloud, const std::vector<const SceneObject*>& left, const PipelineOptions& options) {
  const double reach = reach_m(options);
  std::vector<Sphere> balls, stirred;  // around every object, and around what moved, came or went
  for (const SceneObject& object : objects) {
    balls.push_back(ball_around(object));
    if (changed(object)) stirred.push_back(balls.back());
  }
  for (const SceneObject* object : left) stirred.push_back(ball_around(*object));
  const std::vector<LoosePoint> loose = loose_points(segments, cloud);
  oneapi::tbb::parallel_for(std::size_t{0}, objects.size(), [&](std::size_t i) {
    const bool near_change = std::any_of(stirred.begin(), stirred.end(), [&](const Sphere& ball) { return within(ball, balls[i], reach); });
    if (!near_change && objects[i].grasps.grasps.empty()) return;
    std::vector<Eigen::Vector3f> obstacles = obstacles_of(*views[i], segments, loose, balls[i], reach);
    if (!near_change && clear_of_points(objects[i].grasps, obstacles, options.gripper, options.grasp)) return;  // a static scene costs next to nothing
    StageTimings timings;
    GraspScene scene = surroundings(i, objects, balls, *views[i], reach);
    scene.obstacle_points_camera = std::move(obstacles);
    objects[i].grasps = timings.measure("grasp", [&] { return plan_grasps(objects[i].model, scene, options.gripper, options.grasp); });
    objects[i].ms["grasp"] = timings.ms().at("grasp");
  });
}

}  // namespace gfp
