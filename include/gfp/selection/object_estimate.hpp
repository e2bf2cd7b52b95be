#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

/// What one object is, decided among its fits.
struct ObjectEstimate {
  std::uint64_t id = 0;
  int segment = -1;
  FittedModel model;
  std::map<std::string, double> class_probabilities;  ///< Sums to 1, `unknown` included.
};

}  // namespace gfp
