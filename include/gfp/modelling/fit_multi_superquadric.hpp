#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

struct FitMultiSuperquadricOptions {
  int max_bodies = 5;
  int max_points = 600;
  int max_iterations = 30;  ///< Of each body's last descent.
  int samples = 48;         ///< Of the union's field along its longest side.
  int vertices = 800;       ///< Of the mesh, about.
};

template <class Visitor>
void visit_fields(FitMultiSuperquadricOptions& o, Visitor&& field) {
  field("max_bodies", o.max_bodies, 1, 20);
  field("max_points", o.max_points, 50, 100'000);
  field("max_iterations", o.max_iterations, 1, 1000);
  field("samples", o.samples, 12, 200);
  field("vertices", o.vertices, 100, 5000);
}

/// Several superquadrics for one object (P31, P32; cf. Cocias et al. 2012, and the hierarchy of Liu et al. 2022); needs no class.
///
/// One body is fitted to all points; then, as long as it pays, some body's points are divided, either across one of its axes or into those
/// that it explains and the largest group of those that it does not, and each half gets a body of its own. A division pays if the union
/// explains the seen points by more nats than its parameters cost.
/// @return the isosurface of the union, cut off at the support: closed, oriented, free of self-intersections, of any genus; its largest component.
///         `class_name` "unknown"; a topology of its own. Where nothing tells a shape: fit_superquadric()'s result, renamed.
/// Cost: 0.3 to 1 s. Deterministic, no shared state.
FittedModel fit_multi_superquadric(const ObjectView& view, const FitMultiSuperquadricOptions& options = {});

}  // namespace gfp
