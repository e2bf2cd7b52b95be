#pragma once

#include <vector>

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Mean and principal modes of shapes in correspondence, canonical units.
/// @param members  M >= 2 shapes of N points each, the same vertex at the same index.
/// Fills mean, modes (one standard deviation each, at most `max_modes`, at most M - 1), mode_sigma and residual_sigma.
void average_shapes(const std::vector<std::vector<Eigen::Vector3d>>& members, int max_modes, Primitive& primitive);

/// Mean and covariance of the logarithm of the members' reference sizes.
void average_sizes(const std::vector<Eigen::Vector3d>& sizes_m, Primitive& primitive);

}  // namespace gfp
