#include "pipeline/plan_scene_grasps.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

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

/// Seen points above the table that no object owns: cables, hands, rejected clusters. One pixel in 4 x 4.
std::vector<Eigen::Vector3f> obstacle_points(const Segments& segments, const OrganizedCloud& cloud) {
  constexpr int kStride = 4;
  constexpr double kClearOfPlaneM = 0.015;  // nearer ones may be the table's own noise
  std::vector<Eigen::Vector3f> points;
  if (segments.planes.empty()) return points;
  const Transform T_support_camera = segments.planes.front().T_camera_support.inverse();
  const Eigen::Vector3f up = T_support_camera.linear().row(2).transpose().cast<float>();
  const auto offset = static_cast<float>(T_support_camera.translation().z());
  for (int v = 0; v < segments.height; v += kStride) {
    for (int u = 0; u < segments.width; u += kStride) {
      const std::size_t pixel = segments.labels.index(u, v);
      if (segments.labels.pixels[pixel] != Segments::kUnassigned || !cloud.valid(pixel)) continue;
      if (up.dot(cloud.point(pixel)) + offset > static_cast<float>(kClearOfPlaneM)) points.push_back(cloud.point(pixel));
    }
  }
  return points;
}

GraspScene surroundings(std::size_t self, const std::vector<SceneObject>& objects, const std::vector<Sphere>& balls,
                        const ObjectView& view, const std::vector<Eigen::Vector3f>& obstacles, double reach) {
  GraspScene scene;
  scene.has_support = view.has_support;
  scene.T_camera_support = view.T_camera_support;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (i != self && within(balls[i], balls[self], reach)) scene.neighbours.push_back(&objects[i].model);
  for (const Eigen::Vector3f& point : obstacles)
    if ((point.cast<double>() - balls[self].centre).norm() < balls[self].radius + reach) scene.obstacle_points_camera.push_back(point);
  return scene;
}

bool changed(const SceneObject& object) { return object.status != ObjectStatus::kUnchanged; }

}  // namespace

void plan_scene_grasps(std::vector<SceneObject>& objects, const std::vector<const ObjectView*>& views, const Segments& segments,
                       const OrganizedCloud& cloud, bool someone_left, const PipelineOptions& options) {
  if (!someone_left && std::none_of(objects.begin(), objects.end(), changed)) return;  // a static scene costs nothing
  std::vector<Sphere> balls;
  for (const SceneObject& object : objects) balls.push_back(ball_around(object));
  const double reach = reach_m(options);
  const std::vector<Eigen::Vector3f> obstacles = obstacle_points(segments, cloud);
  const auto needs_plan = [&](std::size_t self) {
    for (std::size_t i = 0; i < objects.size(); ++i)
      if (changed(objects[i]) && within(balls[i], balls[self], reach)) return true;
    return someone_left;
  };
  oneapi::tbb::parallel_for(std::size_t{0}, objects.size(), [&](std::size_t i) {
    if (!needs_plan(i)) return;
    StageTimings timings;
    const GraspScene scene = surroundings(i, objects, balls, *views[i], obstacles, reach);
    objects[i].grasps = timings.measure("grasp", [&] { return plan_grasps(objects[i].model, scene, options.gripper, options.grasp); });
    objects[i].ms["grasp"] = timings.ms().at("grasp");
  });
}

}  // namespace gfp
