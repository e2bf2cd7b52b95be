#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// The paper's internal energies of one contour point (eqs. 4 and 5) as changes from rest (P20, P21), from the mesh's own neighbours
/// (P22), square metres: with displacements u,
///     continuity = mean_j |u_i - u_j|^2,   curvature = |u_i - mean_j u_j|^2.
struct InternalEnergy {
  double continuity = 0, curvature = 0;
};
InternalEnergy internal_energy(const VertexAdjacency& adjacency, const std::vector<Eigen::Vector3d>& displacements, std::int32_t vertex,
                               const Eigen::Vector3d& displacement);

/// A 0/1 weight (P19): 1 where an energy is above its threshold. Between 0.9 and 1.1 of it the weight stays as it is.
class Gate {
 public:
  bool update(double energy_over_threshold) {
    if (energy_over_threshold > 1.1) open_ = true;
    if (energy_over_threshold < 0.9) open_ = false;
    return open_;
  }

 private:
  bool open_ = false;
};

}  // namespace gfp
