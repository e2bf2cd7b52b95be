#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

struct ModellingOptions {
  int max_iterations = 6;         ///< Semi-implicit steps of the contour; 0 keeps the placed shape.
  double membrane_weight = 0.4;   ///< lc of ALGORITHM 2.
  double plate_weight = 1.0;      ///< lb of ALGORITHM 2.
  double symmetry_weight = 0.3;   ///< Of mirrored targets on the hidden side.
};

template <class Visitor>
void visit_fields(ModellingOptions& o, Visitor&& field) {
  field("max_iterations", o.max_iterations, 0, 100);
  field("membrane_weight", o.membrane_weight, 0.0, 100.0);
  field("plate_weight", o.plate_weight, 0.0, 100.0);
  field("symmetry_weight", o.symmetry_weight, 0.0, 10.0);
}

/// The `robust` active contour: from a placed primitive to a closed model of this very object (P17-P27, ALGORITHM 2).
FittedModel model_contour(const ObjectView& view, const Placement& placement, const ModellingOptions& options = {});

}  // namespace gfp
