#pragma once

#include <span>

#include "gfp/grasp/wrench_space.hpp"

namespace gfp::test {

struct HullOracle {
  bool full = false;   ///< False: qhull found the wrenches flat.
  double epsilon = 0;  ///< Signed: least distance of the origin to a facet, negative where it lies outside.
  double volume = 0;
};

/// The convex hull of the wrenches by libqhull_r, the whole of it.
HullOracle qhull_oracle(std::span<const Wrench> wrenches, bool volume = true);

}  // namespace gfp::test
