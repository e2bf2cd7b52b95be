#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/modelling/superquadric.hpp"

namespace gfp {

/// The finite ones among the points.
std::vector<Eigen::Vector3d> finite_points(std::span<const Eigen::Vector3d> points);

/// An ellipsoid about most of the points, in their principal axes, z the longest. Errors: as recover_superquadric_ems().
Result<Superquadric> principal_axes_start(const std::vector<Eigen::Vector3d>& points);

}  // namespace gfp
