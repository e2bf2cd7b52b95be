#include "gfp/grasp/grasp.hpp"

namespace gfp {

GraspPlan moved(GraspPlan plan, const Transform& T_now_before) {
  const Eigen::Matrix3d turn = T_now_before.linear();
  for (Grasp& grasp : plan.grasps) {
    for (Transform* T : {&grasp.T_camera_tcp, &grasp.T_camera_parent, &grasp.T_camera_pregrasp_tcp}) *T = T_now_before * *T;
    for (Eigen::Vector3d* direction : {&grasp.approach, &grasp.helpful_view}) *direction = turn * *direction;
    for (GraspContact& contact : grasp.contacts) {
      contact.point = T_now_before * contact.point;
      contact.normal = turn * contact.normal;
    }
  }
  return plan;
}

}  // namespace gfp
