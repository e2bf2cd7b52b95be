#include "gfp/grasp/judge_grasp.hpp"

#include "gfp/grasp/wrench_space.hpp"
#include "grasp/close_jaw.hpp"
#include "grasp/surroundings.hpp"

namespace gfp {
namespace {

GraspVerdict refused(const char* reason) {
  GraspVerdict verdict;
  verdict.reason = reason;
  return verdict;
}

}  // namespace

GraspVerdict judge_grasp(const TriangleMesh& true_mesh_camera, const Grasp& grasp, const GraspScene& scene, const Gripper& gripper,
                         double min_epsilon) {
  const TriangleBvh bvh(true_mesh_camera.vertices, true_mesh_camera.triangles);
  const double sweep_m = (grasp.T_camera_tcp.translation() - grasp.T_camera_pregrasp_tcp.translation()).norm();
  const GripperBoxes boxes = gripper_boxes(gripper, grasp.T_camera_tcp, grasp.opening_m, sweep_m);
  if (bvh.meets(boxes.fingers[0]) || bvh.meets(boxes.fingers[1]) || bvh.meets(boxes.palm)) return refused("collision_object");
  const double reach_m = sweep_m + gripper.finger_length_m + gripper.palm_depth_m + gripper.palm_width_m + gripper.palm_height_m;
  if (Surroundings(scene, grasp.T_camera_tcp.translation(), reach_m).blocks(boxes, 0)) return refused("collision_scene");
  const auto touches = close_jaw(true_mesh_camera, bvh, gripper, grasp.T_camera_tcp, grasp.opening_m);
  if (!touches) return refused("no_contact");

  GraspVerdict verdict;
  std::array<WrenchContact, 2> contacts;
  for (std::size_t i = 0; i < 2; ++i) {
    verdict.contacts[i].point = grasp.T_camera_tcp * (*touches)[i].point;
    verdict.contacts[i].normal = grasp.T_camera_tcp.linear() * (*touches)[i].normal;
    contacts[i] = {verdict.contacts[i].point, verdict.contacts[i].normal, gripper.friction, gripper.torsion_m};
  }
  verdict.width_m = (*touches)[0].point.y() - (*touches)[1].point.y();
  verdict.epsilon = grasp_quality(contacts, wrench_scale(true_mesh_camera)).epsilon;
  verdict.success = verdict.epsilon >= min_epsilon;
  if (!verdict.success) verdict.reason = "not_force_closure";
  return verdict;
}

}  // namespace gfp
