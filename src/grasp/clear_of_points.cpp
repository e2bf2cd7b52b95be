#include "gfp/grasp/clear_of_points.hpp"

#include <algorithm>

#include "grasp/gripper_boxes.hpp"

namespace gfp {
namespace {

constexpr int kStrayPoints = 3;  // pixels that fly at silhouettes come and go; a hand is many

}  // namespace

bool clear_of_points(const GraspPlan& plan, const std::vector<Eigen::Vector3f>& points_camera, const Gripper& gripper, const PlanGraspsOptions& options) {
  const auto inside = [](const OrientedBox& box, const Eigen::Vector3d& point) { return ((box.T_box_world * point).cwiseAbs() - box.half).maxCoeff() <= 0; };
  return std::none_of(plan.grasps.begin(), plan.grasps.end(), [&](const Grasp& grasp) {
    const GripperBoxes boxes = gripper_boxes(gripper, grasp.T_camera_tcp, grasp.opening_m, options.pregrasp_offset_m);
    const auto met = std::count_if(points_camera.begin(), points_camera.end(), [&](const Eigen::Vector3f& p) {
      const Eigen::Vector3d point = p.cast<double>();
      return inside(boxes.closing, point) || inside(boxes.palm, point);
    });
    return met > kStrayPoints;
  });
}

}  // namespace gfp
