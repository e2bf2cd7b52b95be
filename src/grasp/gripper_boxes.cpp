#include "grasp/gripper_boxes.hpp"

namespace gfp {

GripperBoxes gripper_boxes(const Gripper& gripper, const Transform& T_world_tcp, double opening_m, double sweep_m) {
  const double length = gripper.finger_length_m, across = 0.5 * gripper.finger_width_m;
  const double inner = 0.5 * opening_m, outer = inner + gripper.finger_thickness_m, tail = -length - sweep_m;
  const auto box = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) { return OrientedBox::of({low, high}, T_world_tcp); };
  GripperBoxes boxes;
  boxes.fingers = {box({tail, inner, -across}, {0, outer, across}), box({tail, -outer, -across}, {0, -inner, across})};
  boxes.closing = box({tail, -outer, -across}, {0, outer, across});
  boxes.palm = box({tail - gripper.palm_depth_m, -0.5 * gripper.palm_width_m, -0.5 * gripper.palm_height_m},
                   {-length, 0.5 * gripper.palm_width_m, 0.5 * gripper.palm_height_m});
  return boxes;
}

Bounds gap_tcp(const Gripper& gripper, double opening_m) {
  const double across = 0.5 * gripper.finger_width_m, inner = 0.5 * opening_m;
  return {{-gripper.finger_length_m, -inner, -across}, {0, inner, across}};
}

}  // namespace gfp
