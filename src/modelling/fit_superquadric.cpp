#include "gfp/modelling/fit_superquadric.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/memory/image_score.hpp"
#include "gfp/modelling/recover_superquadric.hpp"
#include "modelling/recover_from_view.hpp"
#include "modelling/volume_model.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kHalfSideOfNothing = 0.01;  ///< Metres: of the box where nothing was seen.

/// Where the tile's middle looks at the support, or 1 m away.
Superquadric box_of_nothing(const ObjectView& view) {
  Superquadric box;
  box.epsilon1 = box.epsilon2 = 0.1;
  box.half_axes_m.setConstant(kHalfSideOfNothing);
  const double u = 0.5 * (view.tile.u0 + view.tile.u1), v = 0.5 * (view.tile.v0 + view.tile.v1);
  const Transform T_support_camera = view.T_camera_support.inverse();
  const Vector3d eye = T_support_camera.translation(), ray = T_support_camera.linear() * view.camera.ray(u, v);
  const double to_support = -eye.z() / ray.z();
  const bool meets = view.has_support && to_support > 0.1 && to_support < 10;
  box.pose.translation() = eye + (meets ? to_support : 1.0) * ray;
  if (view.has_support) box.pose.translation().z() = kHalfSideOfNothing;
  return box;
}

SeenSuperquadric recover_from_points(const SeenSurface& seen, const Superquadric& box, const FitSuperquadricOptions& options) {
  const RecoverSuperquadricOptions recover{.max_iterations = options.max_iterations, .noise_m = seen.sigma_m};
  const auto fit = options.algorithm == SuperquadricAlgorithm::kEms ? recover_superquadric_ems(seen.points, recover)
                                                                     : recover_superquadric_lm(seen.points, recover);
  if (!fit) return {box};
  return {fit->superquadric, std::max(fit->rms_m, seen.sigma_m), fit->iterations, fit->converged};
}

}  // namespace

FittedModel fit_superquadric(const ObjectView& view, const FitSuperquadricOptions& options) {
  const SeenSurface seen = collect_seen_surface(view, options.max_points, kMaxTangents);
  const Superquadric box = seen.points.empty() ? box_of_nothing(view) : box_about(seen.points, view.has_support);
  SeenSuperquadric result{box};
  if (tells_a_shape(seen))
    result = options.algorithm == SuperquadricAlgorithm::kEmsView ? recover_from_view(seen, view.has_support, options.max_iterations) : recover_from_points(seen, box, options);
  if (!is_plausible(result.superquadric, box)) result = {box};
  const auto modelled = [&](const SeenSuperquadric& found) {
    return volume_model(view, {"superquadric", superquadric_topology(), superquadric_vertices(found.superquadric), horizontal_axis(found.superquadric), found.sigma_m,
                               found.pose_information, found.superquadric.pose.translation()});
  };
  FittedModel model = modelled(result);
  if (model.evidence.cost > kMostlyUnexplained) {  // a chair's parts, say: then the box about them is at least where they are
    FittedModel about = modelled({box});
    if (about.evidence.silhouette_iou > model.evidence.silhouette_iou) {
      model = std::move(about);
      result = {box};
    }
  }
  model.iterations = result.iterations;
  model.converged = result.converged;
  return model;
}

}  // namespace gfp
