#pragma once

#include <Eigen/Core>
#include <span>

#include "gfp/core/error.hpp"
#include "gfp/modelling/superquadric.hpp"

namespace gfp {

struct RecoverSuperquadricOptions {
  int max_iterations = 30;       ///< Of each descent.
  double outlier_share = 0.1;    ///< Prior share of points that belong to something else (EMS).
  double noise_m = 0.001;        ///< Standard deviation of the points about the surface; EMS estimates what is above it.
};

struct SuperquadricFit {
  Superquadric superquadric;     ///< In the points' frame.
  double rms_m = 0;              ///< Of surface_distance(); for EMS weighted by the inlier probability.
  int iterations = 0;            ///< Over all descents.
  bool converged = false;        ///< False: stopped at max_iterations, which is a result.
};

/// Robust recovery from points alone: EMS, expectation, maximisation and switching (Liu et al., CVPR 2022).
///
/// A Gaussian-uniform mixture about the surface, its width estimated; when EM has converged, look-alikes (axes exchanged, cross-section
/// turned by 45 degrees) are tried from there, since they are where it gets stuck.
/// @param points  N x 3, metres, any frame; rows that are not finite are skipped.
/// Errors: kTooFewPoints (fewer than 12 finite points), kDegenerateGeometry (all on a line or closer than 1 mm).
/// Cost: O(N) an iteration, about 5 ms for 1000 points. Deterministic, no shared state.
Result<SuperquadricFit> recover_superquadric_ems(std::span<const Eigen::Vector3d> points, const RecoverSuperquadricOptions& options = {});

/// The classic: Levenberg-Marquardt on sqrt(a1 a2 a3) (F^epsilon1 - 1) from the principal axes (Solina and Bajcsy, PAMI 1990).
/// The factor prefers the smallest of the volumes that agree with the points. Every point counts fully. Same errors.
Result<SuperquadricFit> recover_superquadric_lm(std::span<const Eigen::Vector3d> points, const RecoverSuperquadricOptions& options = {});

}  // namespace gfp
