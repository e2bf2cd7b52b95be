#pragma once

#include <vector>

#include "gfp/grasp/wrench_space.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "grasp/triangle_bvh.hpp"

namespace gfp {

/// One draw of how the object may really be, the same for all of its grasps (common random numbers).
struct ShapeDraw {
  Transform T_fit_true = Transform::Identity();  ///< Maps what is fixed in the camera into the fit as if the object had moved.
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();                            ///< Of either contact along its normal, in sigmas.
  std::array<Eigen::Vector2d, 2> slope{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};  ///< Of either normal, in sigmas per correlation length.
  double friction_factor = 1;
};

/// Draws of the shape posterior: the pose covariance moves the object as a whole; FittedModel::sigma_m moves each side along
/// its normal and tilts it by sigma over a correlation length of 30 mm (an error that is smooth over a side); friction is
/// log-normal with 20 %.
std::vector<ShapeDraw> draw_shapes(const FittedModel& model, int count, std::uint64_t seed);

struct ClosureStatistics {
  double p_force_closure = 0;
  double epsilon_lcb = 0;  ///< 10 % quantile.
};

/// A jaw in the camera frame: its pads' centres stand at centre +- 0.5 opening axis.
struct JawLine {
  Eigen::Vector3d centre, axis;
  double opening_m = 0;
};

/// Closes the jaw's centre line on every draw. A draw counts as not closed when the line misses the object, when a pad starts
/// inside it (the finger would land on the object), or when epsilon is below `min_epsilon`.
ClosureStatistics closure_statistics(const JawLine& jaw, const std::vector<ShapeDraw>& draws, const TriangleBvh& bvh,
                                     const std::vector<Eigen::Vector3d>& normals_camera, const std::vector<float>& triangle_sigma_m,
                                     double friction, double torsion_m, const WrenchScale& scale, double min_epsilon);

}  // namespace gfp
