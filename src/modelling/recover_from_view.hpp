#pragma once

#include "modelling/seen_surface.hpp"

namespace gfp {

inline constexpr int kMaxTangents = 80;        ///< Of a view, looked at.
inline constexpr double kModelError = 0.002;   ///< Metres, 1 sigma: things are no superquadrics, nor are their parts.

/// A superquadric as it was recovered: support frame.
struct SeenSuperquadric {
  Superquadric superquadric;
  double sigma_m = 0.01;       ///< Of the seen points about it.
  int iterations = 0;
  bool converged = false;
  Eigen::Matrix<double, 6, 6> pose_information = Eigen::Matrix<double, 6, 6>::Zero();  ///< Support frame, about the centre.
};

/// A nearly sharp upright box about all points (at least one), down to the support where it carries them; at least 10 mm a side.
Superquadric box_about(const std::vector<Eigen::Vector3d>& points, bool on_support);

/// Whether there is enough to recover a body from.
bool tells_a_shape(const SeenSurface& seen);

/// The upright superquadric that passes through the outer points and is grazed by the tangents, standing on the support if `on_support`;
/// round unless something else explains clearly more, leaning if that does. Requires tells_a_shape(seen). Cost: about 10 ms.
SeenSuperquadric recover_from_view(const SeenSurface& seen, bool on_support, int max_iterations);

/// False for a recovery that left the object behind: not finite, or far larger than `box` about what was seen of it.
bool is_plausible(const Superquadric& superquadric, const Superquadric& box);

/// The body's most horizontal axis among x and z: a lying cylinder points along its length.
Eigen::Vector3d horizontal_axis(const Superquadric& superquadric);

}  // namespace gfp
