#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

struct FitSuperquadricOptions {
  int max_points = 1000;
  int max_iterations = 30;
};

/// One superquadric for one object (P32); needs no class. Always gives a closed volume.
FittedModel fit_superquadric(const ObjectView& view, const FitSuperquadricOptions& options = {});

}  // namespace gfp
