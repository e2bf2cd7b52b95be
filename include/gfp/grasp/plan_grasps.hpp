#pragma once

#include <cstdint>

#include "gfp/grasp/grasp.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

struct PlanGraspsOptions {
  int max_grasps = 10;            ///< Published per object, best first.
  int samples = 250;              ///< Fresh contact samples on the deformed mesh.
  double min_epsilon = 1e-4;      ///< Below it a grasp is not force closed in practice.
  double pregrasp_offset_m = 0.10;       ///< Length of the straight approach.
  int approach_angles = 16;              ///< Approach directions about each closing axis.
  double opening_clearance_m = 0.012;    ///< Between pad and object on either side while approaching; 40 % of it where space is tight.
  double scene_clearance_m = 0.003;      ///< Least distance to table, neighbours and obstacles.
  int uncertainty_samples = 24;          ///< Draws of the shape posterior per grasp.
  double abstain_below_p = 0.6;          ///< Least p_force_closure of a grasp to execute; 0.2 more where no contact was seen.
  std::uint64_t seed = 1;
};

template <class Visitor>
void visit_fields(PlanGraspsOptions& o, Visitor&& field) {
  field("max_grasps", o.max_grasps, 0, 1000);
  field("samples", o.samples, 1, 100'000);
  field("min_epsilon", o.min_epsilon, 0.0, 1.0);
  field("pregrasp_offset_m", o.pregrasp_offset_m, 0.0, 1.0);
  field("approach_angles", o.approach_angles, 4, 360);
  field("opening_clearance_m", o.opening_clearance_m, 0.001, 0.1);
  field("scene_clearance_m", o.scene_clearance_m, 0.0, 0.1);
  field("uncertainty_samples", o.uncertainty_samples, 1, 10'000);
  field("abstain_below_p", o.abstain_below_p, 0.0, 1.0);
  field("seed", o.seed, std::uint64_t{0}, UINT64_MAX);
}

/// What the gripper must not touch, beside the object itself; camera frame.
struct GraspScene {
  bool has_support = false;
  Transform T_camera_support = Transform::Identity();      ///< Nothing of the gripper goes below z = 0 of it.
  std::vector<const FittedModel*> neighbours;              ///< Other objects' fits.
  std::vector<Eigen::Vector3f> obstacle_points_camera;     ///< Seen points that belong to nothing modelled.
};

/// Parallel-jaw grasps of one fitted object (ALGORITHM 5, P33), or the reason why there is none.
///
/// Antipodal pairs (the primitive's own, carried by the deformation, and fresh ones) give jaw poses at `approach_angles`
/// about each closing axis; none comes from below the horizontal of the support (without a support: from behind, as the
/// camera sees it). The best are closed on the fitted mesh, checked along the straight approach against object, table,
/// neighbours and obstacles, and valued under the shape's uncertainty. Grips around the body come before those that have the
/// centre of mass beside their pads (a rim), where they are as sure. The list is diverse: no two grasps within 15 mm and
/// 25 degrees. Same model, scene, gripper, options: same bytes.
/// Cost: 1-3 ms for 1200 triangles. Thread-safe: no shared state.
GraspPlan plan_grasps(const FittedModel& model, const GraspScene& scene, const Gripper& gripper = {}, const PlanGraspsOptions& options = {});

}  // namespace gfp
