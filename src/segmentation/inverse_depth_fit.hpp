#pragma once

#include <Eigen/Core>
#include <optional>

namespace gfp {

/// A plane a x + b y + c z = 1 is linear in the image: 1/z = a (x/z) + b (y/z) + c. Triangulating sensors err evenly in
/// 1/z, so least squares there is both the cheap and the right fit. `coefficients` = (a, b, c), 1/m.
struct PlaneFit {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  double rms_inverse_m = 0;  ///< Residual of 1/z, 1/m; times z^2 it is a depth error.

  /// Unit normal towards the camera and the camera's distance: height(p) = up . p + camera_height_m.
  Eigen::Vector3d up() const { return -coefficients.normalized(); }
  double camera_height_m() const { return 1.0 / coefficients.norm(); }
  double residual(double ray_x, double ray_y, double inverse_depth) const {
    return inverse_depth - (coefficients.x() * ray_x + coefficients.y() * ray_y + coefficients.z());
  }
};

/// Sums of the fit; adding two of them joins their samples.
struct InverseDepthSums {
  double n = 0, x = 0, y = 0, w = 0, xx = 0, xy = 0, yy = 0, xw = 0, yw = 0, ww = 0;

  void add(double ray_x, double ray_y, double inverse_depth) {
    n += 1; x += ray_x; y += ray_y; w += inverse_depth;
    xx += ray_x * ray_x; xy += ray_x * ray_y; yy += ray_y * ray_y;
    xw += ray_x * inverse_depth; yw += ray_y * inverse_depth; ww += inverse_depth * inverse_depth;
  }
  void add(const InverseDepthSums& o) {
    n += o.n; x += o.x; y += o.y; w += o.w; xx += o.xx; xy += o.xy; yy += o.yy; xw += o.xw; yw += o.yw; ww += o.ww;
  }
  /// Nothing where the samples lie on a line of the image or the plane passes through the camera.
  std::optional<PlaneFit> solve() const;
};

}  // namespace gfp
