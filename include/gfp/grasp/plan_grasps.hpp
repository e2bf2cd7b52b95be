#pragma once

#include <cstdint>

#include "gfp/grasp/grasp.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

struct PlanGraspsOptions {
  int max_grasps = 10;            ///< Published per object, best first.
  int samples = 400;              ///< Fresh contact samples on the deformed mesh.
  double min_epsilon = 1e-4;      ///< Below it a grasp is not force closed in practice.
  double pregrasp_offset_m = 0.10;
  std::uint64_t seed = 1;
};

template <class Visitor>
void visit_fields(PlanGraspsOptions& o, Visitor&& field) {
  field("max_grasps", o.max_grasps, 0, 1000);
  field("samples", o.samples, 1, 100'000);
  field("min_epsilon", o.min_epsilon, 0.0, 1.0);
  field("pregrasp_offset_m", o.pregrasp_offset_m, 0.0, 1.0);
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
GraspPlan plan_grasps(const FittedModel& model, const GraspScene& scene, const Gripper& gripper = {}, const PlanGraspsOptions& options = {});

}  // namespace gfp
