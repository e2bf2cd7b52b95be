#pragma once

#include <vector>

#include "gfp/grasp/grasp.hpp"
#include "gfp/grasp/plan_grasps.hpp"
#include "grasp/triangle_bvh.hpp"

namespace gfp {

/// Two points of a surface that a jaw can press against each other, camera frame.
struct AntipodalPair {
  Eigen::Vector3d first, second;
  double width_m = 0;
  double cone_use = 0;  ///< Worse contact's tangent of (line, normal) over friction: 0 head-on, 1 about to slip.

  /// Whether the point lies between the two planes through the contacts, square to their line.
  bool spans(const Eigen::Vector3d& point) const { return (point - first).dot(second - first) > 0 && (point - second).dot(first - second) > 0; }
};

struct PairSearch {
  std::vector<AntipodalPair> pairs;  ///< Inside friction cones and stroke.
  std::vector<AntipodalPair> too_wide;  ///< Would close, but not inside the stroke.
};

/// Antipodal pairs of a surface (ALGORITHM 5): the primitive's stored pairs, carried by face and barycentric coordinates and
/// checked again, then fresh ones: area-weighted points, a ray along the inward normal and one tilted inside the friction
/// cone, and every exit of the ray, so that a hollow thing offers its wall (rim grasps) beside its whole body.
/// `widest_m`, `narrowest_m`: what the jaw takes, its clearance already off. `normals`: unit, outward, per triangle.
PairSearch find_antipodal_pairs(const FittedModel& model, const TriangleMesh& mesh_camera, const std::vector<Eigen::Vector3d>& normals,
                                const TriangleBvh& bvh, double friction, double narrowest_m, double widest_m,
                                const PlanGraspsOptions& options);

}  // namespace gfp
