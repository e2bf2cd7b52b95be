#pragma once

#include <vector>

#include "gfp/memory/object_view.hpp"
#include "modelling/superquadric_residual.hpp"

namespace gfp {

/// What an ObjectView shows of its object, in the support frame (z up, the support is z = 0), metres.
struct SeenSurface {
  std::vector<Eigen::Vector3d> points;  ///< Evenly taken from the mask, in raster order.
  std::vector<Eigen::Vector3d> outer_points;  ///< Those of `points` on the near side of their convex hull: not inside a cavity.
  std::vector<Ray> tangents;            ///< Lines of sight just beside the mask where the sensor saw past the object.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< The camera.
  double sigma_m = 0.001;               ///< Noise of a reading at the points' mean depth.
  double pixel_m = 0.001;               ///< Width of a pixel there.
};

/// The points on the near side of their convex hull: some plane through the point, facing the eye, has (almost) all others behind it.
/// The inside of a cup has none, and no convex body can explain it.
std::vector<Eigen::Vector3d> near_side_of_hull(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& eye);

SeenSurface collect_seen_surface(const ObjectView& view, int max_points, int max_tangents);

}  // namespace gfp
