#include "gfp/modelling/model_contour.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/core/mesh.hpp"
#include "gfp/core/self_intersections.hpp"
#include "gfp/modelling/contour_solver.hpp"
#include "gfp/modelling/evaluate_fit.hpp"
#include "gfp/primitive/class_distance.hpp"
#include "modelling/model_of_placement.hpp"
#include "modelling/surface_targets.hpp"
#include "modelling/symmetry_carry.hpp"
#include "modelling/vertex_sigma.hpp"

// Global first, then local (ALGORITHM 2): the placement already carries pose, size and modes. Here the surface moves along its normals
// onto the data (P25), smoothly (P20-P23, relative to the placed shape), symmetric counterparts follow, and whatever would fold or
// cross itself is taken back. All in the support frame, metres.

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kFirstGateM = 0.015, kLastGateM = 0.008;  ///< Data farther along the normal is another surface.
constexpr int kStepsPerTarget = 3;                         ///< Semi-implicit steps before visibility and targets are looked up again.
constexpr double kSettledM = 1e-4;                         ///< P25: the largest move of a settled contour.
constexpr double kMovedM = 3e-4;                           ///< A vertex that moved less is frozen (P27).
constexpr int kLocalRetreats = 3;
constexpr double kLeastFlip = 0.1;                         ///< Cosine between a triangle's normal before and after.

struct Contour {
  std::vector<Vector3d> rest, vertices;  ///< Placed and current.
  SurfaceTargets data;                   ///< Of the last look at the image, without what symmetry added.
  std::vector<double> energies;
  int iterations = 0;
  bool settled = false;
  bool sound = false;  ///< Looked at, and neither folds nor crosses itself.
};

std::vector<Vector3d> displaced(const std::vector<Vector3d>& rest, const Eigen::MatrixX3d& u, double share) {
  std::vector<Vector3d> result(rest);
  for (std::size_t i = 0; i < rest.size(); ++i) result[i] += share * u.row(static_cast<Eigen::Index>(i)).transpose();
  return result;
}

/// Moves the rest shape onto the data. Not sound where not even the rest shape is.
void run_contour(const ObjectView& view, const Primitive& primitive, const ModellingOptions& options, Contour& contour) {
  const auto& triangles = primitive.topology->triangles;
  const auto solver = contour_solver(primitive, options);
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(contour.rest.size()), 3);
  double gate = kFirstGateM;
  while (contour.iterations < options.max_iterations && !contour.settled) {
    const auto normals = vertex_normals({contour.vertices, triangles});
    contour.data = surface_targets(view, contour.vertices, normals, triangles, gate);
    SurfaceTargets targets = contour.data;
    // Targets count from where the vertex is now; the solver's count from rest.
    for (std::size_t i = 0; i < targets.distance_m.size(); ++i)
      targets.distance_m[i] += normals[i].dot(u.row(static_cast<Eigen::Index>(i)).transpose());
    carry_by_symmetry(primitive, options.symmetry_weight, targets);
    double move = 0;
    for (int k = 0; k < kStepsPerTarget && contour.iterations < options.max_iterations; ++k, ++contour.iterations) {
      contour.energies.push_back(solver->energy(u, normals, targets.distance_m, targets.weight));
      const Eigen::MatrixX3d next = solver->step(u, normals, targets.distance_m, targets.weight);
      move = (next - u).rowwise().norm().maxCoeff();
      u = next;
    }
    contour.settled = move < kSettledM;
    contour.vertices = displaced(contour.rest, u, 1.0);
    gate = std::max(kLastGateM, 0.6 * gate);
  }
  // Retreats: what folds or crosses is held back, with its surroundings; where that is not enough, all of it.
  Approach reached = approach_without_crossing(contour.rest, displaced(contour.rest, u, 1.0), triangles, {.local_rounds = kLocalRetreats, .then = {0.7, 0.4, 0.15, 0.0}, .least_turn_cosine = kLeastFlip});
  contour.vertices = std::move(reached.vertices);
  contour.sound = reached.sound;
}

/// On the table, not in it and not above it.
void settle_on_support(const ObjectView& view, std::vector<Vector3d>& vertices) {
  if (!view.has_support) return;
  double lowest = 1e300;
  for (const auto& v : vertices) lowest = std::min(lowest, v.z());
  for (auto& v : vertices) v.z() -= lowest;
}

/// Places the shape and runs the contour on it, with modes shrunk until the result does not cross itself; an affinely scaled mean
/// shape never does.
Contour model_shape(const ObjectView& view, const Placement& placement, const Transform& T_support_object, const ModellingOptions& options,
                    std::vector<double>& modes) {
  const Primitive& primitive = *placement.primitive;
  Contour contour;
  for (const double share : {1.0, 0.6, 0.3, 0.0}) {
    modes = placement.modes;
    for (auto& b : modes) b *= share;
    contour = {};
    contour.rest = transformed(shape(primitive, placement.size_m, modes), T_support_object);
    settle_on_support(view, contour.rest);
    contour.vertices = contour.rest;
    run_contour(view, primitive, options, contour);
    if (contour.sound) break;
  }
  settle_on_support(view, contour.vertices);
  return contour;
}

}  // namespace

FittedModel model_contour(const ObjectView& view, const Placement& placement, const ModellingOptions& options) {
  const Primitive& primitive = *placement.primitive;
  const auto& triangles = primitive.topology->triangles;
  const Transform T_support_object = view.T_camera_support.inverse() * placement.T_camera_object;
  FittedModel model = model_of_placement(placement, "gfp_robust");
  Contour contour = model_shape(view, placement, T_support_object, options, model.modes);

  model.vertices = transformed(contour.vertices, T_support_object.inverse());
  model.energies = std::move(contour.energies);
  model.iterations = contour.iterations;
  if (contour.sound) model.self_intersections = 0;
  model.converged = contour.settled && placement.converged;

  const auto vertices_camera = transformed(contour.vertices, view.T_camera_support);
  model.evidence = evaluate_fit(view, vertices_camera, triangles, model.states);
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    if (primitive.topology->types[i] == PointType::kControl) model.states[i] |= kVertexControl;
    if ((contour.vertices[i] - contour.rest[i]).norm() > kMovedM) model.states[i] |= kVertexMoved;
  }
  contour.data.distance_m.resize(model.vertices.size(), 0);
  contour.data.readings.resize(model.vertices.size(), 0);  // no look at the image where no iteration was asked for
  model.sigma_m = vertex_sigma(view, placement, contour.data, model.states, contour.vertices, vertex_normals({contour.vertices, triangles}));
  const Eigen::VectorXd modes = Eigen::Map<const Eigen::VectorXd>(model.modes.data(), static_cast<Eigen::Index>(model.modes.size()));
  model.evidence.mahalanobis = std::sqrt(class_distance_squared(primitive, placement.size_m.array().log().matrix(), modes));
  return model;
}

}  // namespace gfp
