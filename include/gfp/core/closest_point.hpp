#pragma once

#include <Eigen/Core>

namespace gfp {

/// The point of triangle abc (filled) that is nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace gfp
