#pragma once

#include <vector>

#include "gfp/core/transform.hpp"

namespace gfp {

struct IcpResult {
  Transform T_target_source = Transform::Identity();
  double mean_squared_m2 = 0;  ///< From the moved source points to their nearest target points.
  bool converged = false;
};

/// PCL's iterative closest points (P14), point to point. No iterations or no points: the identity, not converged.
IcpResult align_icp(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target, int max_iterations);

}  // namespace gfp
