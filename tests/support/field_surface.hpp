#pragma once

#include <array>

#include "gfp/core/isosurface.hpp"

namespace gfp::test {

/// The closed surface where `inside` (metres, positive within) is zero, on a grid from `low` with `counts` points `step_m` apart.
template <class Inside>
TriangleMesh field_surface(const Inside& inside, const Eigen::Vector3d& low, double step_m, const std::array<int, 3>& counts) {
  ScalarGrid grid(low, step_m, {counts[0], counts[1], counts[2]});
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i) grid.values[grid.index(i, j, k)] = static_cast<float>(inside(grid.place({i, j, k})));
  return isosurface(grid, 0.0F);
}

}  // namespace gfp::test
