#pragma once

#include "gfp/primitive/primitive.hpp"

namespace gfp {

/// Squared Mahalanobis distance of a size and modes from the class's mean: twice what they cost in negative log prior.
/// @param log_size  log(reference size in metres).
/// @param modes     coefficients in standard deviations.
double class_distance_squared(const Primitive& primitive, const Eigen::Vector3d& log_size, const Eigen::VectorXd& modes);

}  // namespace gfp
