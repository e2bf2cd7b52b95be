#pragma once

#include <vector>

#include "gfp/core/transform.hpp"

namespace gfp {

struct IcpResult {
  Transform T_target_source = Transform::Identity();
  double mean_squared_m2 = 0;  ///< From the moved source points to their nearest target points.
  bool converged = false;
  int iterations = 0;
};

/// Iterative closest points, point to point (Besl and McKay 1992), each to its exact nearest: first shares of the source, then all of it, with
/// steps drawn out as long as that pays. A point's nearest is looked for again only when it has moved far enough for another to be nearer.
/// Ends when a step with all points lowers the squared error by less than 0.05 %.
/// @param source, target  at least 3 points each, metres; too few of either or no iterations give the identity, not converged.
/// Deterministic. Cost: 1 ms for 3000 points onto 400, 6 ms for 10,000 onto 2400.
IcpResult align_icp(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target, int max_iterations);

/// The same by PCL: the paper's profile. Does not say how many iterations it took.
IcpResult align_icp_pcl(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target, int max_iterations);

}  // namespace gfp
