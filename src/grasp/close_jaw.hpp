#pragma once

#include <array>
#include <optional>

#include "gfp/grasp/grasp.hpp"
#include "grasp/triangle_bvh.hpp"

namespace gfp {

inline constexpr double kPadGive = 0.0015;  ///< Metres: how far a rubber pad yields.

/// One pad's touch, tcp frame.
struct PadTouch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< Centre of pressure.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Into the object, unit.
  std::int32_t triangle = -1;                        ///< The one that bears most.
};

/// The pads of a jaw at T_world_tcp, open to `opening_m`, close along y until each rests on the mesh, the object staying where
/// it is (a real jaw centres itself or the object).
///
/// A pad is a plane rectangle of soft rubber, an elastic (Winkler) foundation: past the first point it meets it yields by
/// kPadGive, and what it meets on the way presses in proportion to its depth in the pad. The contact is that pressure's
/// centre, with the pressure-weighted mean normal; a bare edge or corner gets the pad's own normal.
/// @return touches of the pads at +y and at -y, or nothing where the gap is empty.
std::optional<std::array<PadTouch, 2>> close_jaw(const TriangleMesh& mesh_world, const TriangleBvh& bvh, const Gripper& gripper,
                                                 const Transform& T_world_tcp, double opening_m);

}  // namespace gfp
