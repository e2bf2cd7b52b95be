#pragma once

#include <vector>

#include "modelling/superquadric_residual.hpp"

// Expectation-maximisation of a Gaussian-uniform mixture about a superquadric's surface (Liu et al., CVPR 2022): points are
// either on the surface, with a Gaussian error whose width is estimated, or anywhere (the uniform part); the M-step is one
// Levenberg-Marquardt step. Beyond the paper it takes what a view knows besides points: rays that graze the body (its seen
// silhouette), which say where the hidden side ends, and the plane that the body stands on.

namespace gfp {

/// What a superquadric is fitted to. With `on_base` the frame's plane z = 0 carries the body; else any frame.
struct SuperquadricData {
  std::vector<Eigen::Vector3d> points;  ///< Seen surface, metres.
  std::vector<Ray> tangents;            ///< Lines of sight along the object's outline: they touch the surface.
  double sigma_m = 0.001;               ///< Sensor noise of the points: the Gaussian's width never falls below.
  double tangent_sigma_m = 0.001;       ///< Half a pixel at the object's distance.
  double range_m = 0.1;                 ///< Distances over which the uniform part spreads.
  bool on_base = false;
  SuperquadricLimits limits;
};

/// The same with at most so many points and tangents, evenly taken.
SuperquadricData thinned(const SuperquadricData& problem, std::size_t points, std::size_t tangents = 0);

/// Which of the parameters are free.
struct SuperquadricFreedom {
  enum class Rotation { kFree, kAboutVertical };  ///< Vertical: the frame's z axis.
  enum class Axes { kFree, kRound, kBall };       ///< Round: a1 = a2; ball: a1 = a2 = a3.
  Rotation rotation = Rotation::kFree;
  Axes axes = Axes::kFree;
  bool epsilon1 = true, epsilon2 = true;
};

struct EmOptions {
  int max_iterations = 30;
  double outlier_share = 0.1;     ///< Prior weight of the uniform part.
  double tangent_weight = 0.5;    ///< All tangents together weigh as much as this share of the points.
  double independence = 0.05;     ///< Neighbouring pixels err alike, above all where the object is no superquadric: this share counts.
};

struct EmFit {
  Superquadric superquadric;
  double sigma_m = 0;        ///< Estimated width of the Gaussian part.
  double objective = 0;      ///< Negative log likelihood and priors; smaller is better, comparable for the same data and options.
  int iterations = 0;
  bool converged = false;
  Eigen::Matrix<double, kSuperquadricParameters, kSuperquadricParameters> information =
      Eigen::Matrix<double, kSuperquadricParameters, kSuperquadricParameters>::Zero();  ///< Of the last step's parameters.
};

/// Runs EM from `start`. Never fails: the result is at least as probable as the start, and finite if the data are.
EmFit maximise(const SuperquadricData& problem, const Superquadric& start, const SuperquadricFreedom& freedom, const EmOptions& options);

/// Other superquadrics that look much alike where EM may be stuck (the S of EMS): the axes exchanged, and the cross-section turned
/// by 45 degrees with epsilon2 -> 2 - epsilon2.
std::vector<Superquadric> similar_shapes(const Superquadric& superquadric);

}  // namespace gfp
