#pragma once

#include <array>

#include "gfp/grasp/grasp.hpp"
#include "grasp/box.hpp"

namespace gfp {

/// The gripper as boxes in the world, open to `opening_m`, swept back along its approach by `sweep_m` (0: in place).
struct GripperBoxes {
  std::array<OrientedBox, 2> fingers;  ///< At +y, at -y of the tcp frame.
  OrientedBox palm;
  OrientedBox closing;                 ///< Both fingers and the gap they close through.
};
GripperBoxes gripper_boxes(const Gripper& gripper, const Transform& T_world_tcp, double opening_m, double sweep_m);

/// The gap between the pads, in tcp coordinates: what is inside can be touched when the jaw closes.
Bounds gap_tcp(const Gripper& gripper, double opening_m);

}  // namespace gfp
