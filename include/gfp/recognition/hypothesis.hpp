#pragma once

#include <map>
#include <string>
#include <vector>

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// "This cluster may be a <class>": what registration is asked to try.
struct Hypothesis {
  PrimitivePtr primitive;
  double log_prior = 0;                 ///< Natural log of the class's probability before any fit.
  std::vector<int> stable_poses;        ///< Which of the primitive's stable poses to try, best first.
};

}  // namespace gfp
