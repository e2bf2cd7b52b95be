#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

enum class SuperquadricAlgorithm {
  kEmsView,              ///< EMS that also knows the outline's lines of sight and the table: the default.
  kEms,                  ///< EMS of the seen points alone, as published (Liu et al. 2022), then lifted onto the table.
  kLevenbergMarquardt,   ///< Solina and Bajcsy (1990) on the seen points, then lifted onto the table.
};

struct FitSuperquadricOptions {
  SuperquadricAlgorithm algorithm = SuperquadricAlgorithm::kEmsView;
  int max_points = 600;
  int max_iterations = 30;  ///< Of the last descent.
};

template <class Visitor>
void visit_fields(FitSuperquadricOptions& o, Visitor&& field) {
  field("max_points", o.max_points, 50, 100'000);
  field("max_iterations", o.max_iterations, 1, 1000);
}

/// One superquadric for one object (P32); needs no class, so it is the fallback hypothesis of every cluster.
///
/// Finds the upright superquadric that stands on the support, passes through the seen points and is grazed by the lines of sight along
/// the object's free outline, which say where the hidden side ends; what neither decides follows weak priors (sides of like length).
/// @return always a closed, oriented volume free of self-intersections and not below its support, `class_name` "unknown", topology
///         superquadric_topology(). Too few or degenerate points give a box about them with `converged` false; no points at all
///         a 20 mm box where the tile's centre looks at the support (or 1 m away).
/// Cost: about 10 ms. Deterministic, no shared state.
FittedModel fit_superquadric(const ObjectView& view, const FitSuperquadricOptions& options = {});

}  // namespace gfp
