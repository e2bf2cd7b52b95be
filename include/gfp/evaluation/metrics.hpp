#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "gfp/evaluation/truth.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

/// Vertices whose true error lies within their stated sigma, for pooling over many fits.
struct SigmaCoverage {
  int within = 0, vertices = 0;
};

/// How one fit compares with the true object (ALGORITHM 7). Lengths in metres. Starts as the worst there is: no fit at all.
struct FitMetrics {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  double iou_filled = 0;              ///< Filled volumes (fill_solid, truth's up axis), intersection over union.
  double iou_material = 0;
  double volume_error = 1;            ///< |V_fit - V_true| / V_true of the filled volumes.
  double chamfer_m = kInfinity;               ///< Mean of the two one-way mean distances, true surface <-> fit, points uniform by area.
  double hidden_chamfer_m = kInfinity;        ///< Mean distance of the true surface that the camera does not see to the fit.
  double observed_median_m = kInfinity;       ///< Median distance of the true surface that the camera sees to the fit.
  double fscore_5mm = 0;              ///< Harmonic mean of the two shares of points within 5 mm.
  bool closed = false;
  int self_intersections = 0;
  double fit_similarity = 0;          ///< P28 of the measured points to the fit, gamma = 1/(5 mm)^2.
  double fit_similarity_true = 0;     ///< The same to the true surface: what a perfect fit scores.
  SigmaCoverage sigma_observed, sigma_inferred;
  std::optional<double> yaw_error_rad;  ///< Modulo the shape's period; empty where yaw means nothing or the frames differ.
};

/// Compares a fit with the truth.
/// @param points_camera  the object's measured points, metres, camera frame (at most `kSimilarityPoints` are used).
/// A fit that is empty or not finite is a result, the worst; one too large to be voxelised has IoU 0 and volume error 1.
/// Cost: about 20 ms for a fit of 1200 triangles and a true mesh of 16000.
FitMetrics measure_fit(const TruthView& truth, const FittedModel& fit, std::span<const Eigen::Vector3d> points_camera);

inline constexpr int kSimilarityPoints = 2000;

/// P28: mean of 1 / (1 + (d / 5 mm)^2) over the points (frame of the tree).
double fit_similarity(const TriangleTree& surface, std::span<const Eigen::Vector3d> points);

}  // namespace gfp
