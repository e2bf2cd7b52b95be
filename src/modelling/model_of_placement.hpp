#pragma once

#include <string>

#include "gfp/modelling/fitted_model.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

/// What a placement says of the model that is made from it; vertices, states, sigma and evidence are the method's.
FittedModel model_of_placement(const Placement& placement, const std::string& method);

}  // namespace gfp
