#include "judge_plan.hpp"

#include <algorithm>

#include "gfp/grasp/judge_grasp.hpp"

namespace gfp {
namespace {

constexpr std::size_t kGrasps = 5;

GraspScene seen_scene(const ObjectView& view) {
  GraspScene scene;
  scene.has_support = view.has_support;
  scene.T_camera_support = view.T_camera_support;
  for (int j = 0; j < view.tile.height(); ++j)
    for (int i = 0; i < view.tile.width(); ++i) {
      const double depth = view.depth_m.at(i, j);
      if (view.evidence.at(i, j) != Evidence::kOther || depth <= 0) continue;
      scene.obstacle_points_camera.push_back((depth * view.camera.ray(view.tile.u0 + i, view.tile.v0 + j)).cast<float>());
    }
  return scene;
}

}  // namespace

PlanVerdict judge_plan(const FittedModel& fit, const ObjectView& view, const EvaluationCase& shown, const PipelineOptions& options) {
  const GraspPlan plan = plan_grasps(fit, seen_scene(view), options.gripper, options.grasp);
  GraspScene truth;
  truth.has_support = shown.T_camera_support.has_value() || view.has_support;
  truth.T_camera_support = shown.T_camera_support.value_or(view.T_camera_support);
  truth.obstacle_points_camera = shown.others_camera;
  const TriangleMesh true_mesh_camera = transformed(shown.truth.shape->mesh, shown.truth.T_camera_object);
  PlanVerdict verdict;
  for (std::size_t i = 0; i < std::min(plan.grasps.size(), kGrasps); ++i) {
    const bool success = judge_grasp(true_mesh_camera, plan.grasps[i], truth, options.gripper).success;
    if (i == 0) verdict.first = success;
    verdict.any_of_five = verdict.any_of_five || success;
  }
  return verdict;
}

}  // namespace gfp
