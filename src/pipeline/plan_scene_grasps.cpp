#include "pipeline/plan_scene_grasps.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "gfp/core/spread_directions.hpp"
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

GraspScene surroundings(std::size_t self, const std::vector<GraspSubject>& subjects, const std::vector<Sphere>& balls, double reach) {
  GraspScene scene;
  scene.has_support = subjects[self].view->has_support;
  scene.T_camera_support = subjects[self].view->T_camera_support;
  for (std::size_t i = 0; i < subjects.size(); ++i)
    if (i != self && within(balls[i], balls[self], reach)) scene.neighbours.push_back(&subjects[i].object->model);
  return scene;
}

constexpr double kSamePlaceM = 0.003;  ///< What moves by less is where it was: the gripper's clearance.

/// How far a body reaches in directions spread over the sphere, frame `T`'s, from that frame's origin.
std::vector<double> reaches(const std::vector<Eigen::Vector3d>& vertices, const Transform& T) {
  constexpr int kDirections = 32;
  std::vector<double> farthest;
  for (const Eigen::Vector3d& direction : spread_directions(kDirections)) {
    const Eigen::Vector3d turned = T.linear().transpose() * direction;
    double most = -1e300;
    for (std::size_t i = 0; i < vertices.size(); i += 3) most = std::max(most, turned.dot(vertices[i]));
    farthest.push_back(most + direction.dot(T.translation()));
  }
  return farthest;
}

/// How far the hull of `other` moved as seen from `self`. Not its vertices: a bowl that was found turned about its axis is where it was.
double moved_m(const GraspSubject& self, const GraspSubject& other) {
  const auto now = reaches(other.object->model.vertices, self.object->model.T_camera_object.inverse() * other.object->model.T_camera_object);
  const auto before = reaches(other.before->model.vertices, self.before->model.T_camera_object.inverse() * other.before->model.T_camera_object);
  double farthest = 0;
  for (std::size_t k = 0; k < now.size(); ++k) farthest = std::max(farthest, std::abs(now[k] - before[k]));
  return farthest;
}

bool stands_as_before(const GraspSubject& subject) {
  if (subject.view->has_support != subject.view_before->has_support) return false;
  if (!subject.view->has_support) return true;
  const Transform T_object_support = subject.object->model.T_camera_object.inverse() * subject.view->T_camera_support;
  const Transform T_object_support_before = subject.before->model.T_camera_object.inverse() * subject.view_before->T_camera_support;
  const Eigen::Vector3d up = T_object_support.linear().col(2), up_before = T_object_support_before.linear().col(2);
  const double rises = up.dot(T_object_support.translation()) - up_before.dot(T_object_support_before.translation());
  const double tilts = (up - up_before).norm() * bounds(subject.object->model.vertices).size().norm();
  return std::abs(rises) < kSamePlaceM && tilts < kSamePlaceM;
}

bool is_carried(const GraspSubject& subject) {
  return subject.before && subject.view_before && subject.object->model.vertices == subject.before->model.vertices && stands_as_before(subject);
}

bool neighbours_stayed(std::size_t self, const std::vector<GraspSubject>& subjects, const std::vector<Sphere>& balls, double reach) {
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    if (i == self || !within(balls[i], balls[self], reach)) continue;
    if (!subjects[i].before || moved_m(subjects[self], subjects[i]) > kSamePlaceM) return false;
  }
  return true;
}

}  // namespace

void plan_scene_grasps(const std::vector<GraspSubject>& subjects, const Segments& segments, const OrganizedCloud& cloud,
                       const std::vector<const SceneObject*>& left, const PipelineOptions& options) {
  const double reach = reach_m(options);
  std::vector<Sphere> balls, gaps;  // around every object, and around what is gone
  for (const GraspSubject& subject : subjects) balls.push_back(ball_around(*subject.object));
  for (const SceneObject* object : left) gaps.push_back(ball_around(*object));
  const std::vector<LoosePoint> loose = loose_points(segments, cloud);
  oneapi::tbb::parallel_for(std::size_t{0}, subjects.size(), [&](std::size_t i) {
    const GraspSubject& subject = subjects[i];
    SceneObject& object = *subject.object;
    const bool beside_gap = std::any_of(gaps.begin(), gaps.end(), [&](const Sphere& gap) { return within(gap, balls[i], reach); });
    const bool kept = is_carried(subject) && !beside_gap && neighbours_stayed(i, subjects, balls, reach);
    if (kept) object.grasps = moved(subject.before->grasps, object.model.T_camera_object * subject.before->model.T_camera_object.inverse());
    if (kept && object.grasps.grasps.empty()) return;
    std::vector<Eigen::Vector3f> obstacles = obstacles_of(*subject.view, segments, loose, balls[i], reach);
    if (kept && clear_of_points(object.grasps, obstacles, options.gripper, options.grasp)) return;
    StageTimings timings;
    GraspScene scene = surroundings(i, subjects, balls, reach);
    scene.obstacle_points_camera = std::move(obstacles);
    object.grasps = timings.measure("grasp", [&] { return plan_grasps(object.model, scene, options.gripper, options.grasp); });
    object.ms["grasp"] = timings.ms().at("grasp");
  });
}

}  // namespace gfp
