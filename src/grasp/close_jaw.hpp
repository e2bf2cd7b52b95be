#pragma once

#include <array>
#include <optional>

#include "gfp/grasp/grasp.hpp"
#include "grasp/triangle_bvh.hpp"

namespace gfp {

/// One pad's touch, tcp frame.
struct PadTouch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Into the object, unit.
  std::int32_t triangle = -1;                        ///< The one with the largest share of the touch.
};

/// The pads of a jaw at T_world_tcp, open to `opening_m`, close along y until each touches the mesh, the object staying where
/// it is (a real jaw centres itself or the object). A pad is a plane rectangle with `kPadGive` of soft rubber: it touches
/// the surface that lies within that depth of the first point it meets; the contact is that patch's area centroid and its
/// mean normal, or the pad's own normal where it meets a bare edge or corner.
/// @return touches of the pads at +y and at -y, or nothing where the gap is empty.
std::optional<std::array<PadTouch, 2>> close_jaw(const TriangleMesh& mesh_world, const TriangleBvh& bvh, const Gripper& gripper,
                                                 const Transform& T_world_tcp, double opening_m);

inline constexpr double kPadGive = 0.0005;  ///< Metres.

}  // namespace gfp
