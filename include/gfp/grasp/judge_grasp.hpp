#pragma once

#include <array>
#include <string>

#include "gfp/core/mesh.hpp"
#include "gfp/grasp/grasp.hpp"
#include "gfp/grasp/plan_grasps.hpp"

namespace gfp {

struct GraspVerdict {
  bool success = false;
  /// Why not; empty on success: `collision_object`, `collision_scene` (on the straight approach, jaw open), `no_contact`
  /// (nothing between the pads), `not_force_closure` (epsilon below the bound).
  std::string reason;
  double epsilon = 0;   ///< On the true surface, exact; 0 without contacts.
  double width_m = 0;   ///< Opening when both pads touch.
  std::array<GraspContact, 2> contacts;  ///< On the true surface; pad at +y of the tcp frame first.
};

/// What a grasp does to the true object: the truth for success at 1 and at 5 (ALGORITHM 7).
///
/// The jaw, open to Grasp::opening_m, comes along the straight approach: none of its boxes may touch the object, the table,
/// a neighbour or an obstacle point. Then the pads (plane rectangles with half a millimetre of give) close until each
/// touches; the contacts found, as soft fingers with the gripper's friction and torsion, must give an epsilon of at least
/// `min_epsilon`, with torques about the true mesh's centroid over its bounding radius. The object does not move before
/// both pads touch and gravity plays no part.
///
/// @param true_mesh_camera  closed, outward triangles, metres, camera frame.
GraspVerdict judge_grasp(const TriangleMesh& true_mesh_camera, const Grasp& grasp, const GraspScene& scene, const Gripper& gripper,
                         double min_epsilon = 1e-4);

}  // namespace gfp
