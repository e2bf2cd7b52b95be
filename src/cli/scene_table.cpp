#include "cli/scene_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gfp {
namespace {

double total_ms(const Scene& scene) {
  const auto total = scene.ms.find("total");
  if (total != scene.ms.end()) return total->second;
  double sum = 0;
  for (const auto& [stage, ms] : scene.ms) sum += ms;
  return sum;
}

std::string grasp_text(const GraspPlan& plan) {
  if (plan.grasps.empty()) return plan.no_grasp_reason.empty() ? "none" : plan.no_grasp_reason;
  const Grasp& best = plan.grasps.front();
  return fmt::format("{} ({:.0f} mm, P {:.2f}{})", plan.grasps.size(), 1e3 * best.width_m, best.p_force_closure, best.abstain ? ", unsure" : "");
}

std::string object_line(const SceneObject& object) {
  const FittedModel& model = object.model;
  const Eigen::Vector3d at = model.T_camera_object.translation();
  const Eigen::Vector3d size_mm = model.vertices.empty() ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(1e3 * bounds(model.vertices).size());
  const auto probability = object.class_probabilities.find(model.class_name);
  return fmt::format("{:>5}  {:<14} {:>3.0f} %  {:>6.3f} {:>6.3f} {:>6.3f}  {:>4.0f} x {:>4.0f} x {:>4.0f}  {:>6.3f}  {:>5.1f}  {:<6} {}\n", object.id, model.class_name,
                     probability == object.class_probabilities.end() ? 0.0 : 100 * probability->second, at.x(), at.y(), at.z(), size_mm.x(), size_mm.y(), size_mm.z(),
                     1e3 * object.volume_filled_m3, 1e3 * model.evidence.rms_m, object.closed ? "closed" : "OPEN", grasp_text(object.grasps));
}

}  // namespace

std::string scene_table(const Scene& scene) {
  std::string text = fmt::format("sensor {}  frame {}  {} object(s)  {}  {:.1f} ms\n", scene.sensor, scene.sequence, scene.objects.size(),
                                 scene.support ? "on a table" : "no table", total_ms(scene));
  text += fmt::format("{:>5}  {:<14} {:>5}  {:>20}  {:>18}  {:>6}  {:>5}  {:<6} {}\n", "id", "class", "sure", "x y z in m", "size in mm", "litres", "rms", "mesh", "grasps");
  for (const SceneObject& object : scene.objects) text += object_line(object);
  return text;
}

}  // namespace gfp
