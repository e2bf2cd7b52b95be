#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

namespace gfp {

/// `count` unit vectors spread evenly over the sphere (Fibonacci lattice), from the highest to the lowest.
inline std::vector<Eigen::Vector3d> spread_directions(int count) {
  std::vector<Eigen::Vector3d> all;
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, angle = k * std::numbers::pi * (3 - std::sqrt(5.0)), across = std::sqrt(1 - z * z);
    all.emplace_back(across * std::cos(angle), across * std::sin(angle), z);
  }
  return all;
}

}  // namespace gfp
