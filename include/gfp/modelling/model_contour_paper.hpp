#pragma once

#include <string>

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/contour_trace.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

struct PaperContourOptions {
  double step_m = 0.001;                  ///< Of the contour in one iteration, and between the places that a control looks at (P25).
  double search_share = 0.25;             ///< How far a control looks for data: this share of the circumscribed sphere's radius...
  double max_search_m = 0.030;            ///< ...and no farther.
  double density_radius_spacings = 1.75;  ///< Radius in which scene points are counted, in spacings of the scene's points (P24).
  double continuity_edges = 1.5;          ///< Gate alpha opens above (this x rest edge)^2 (P19)...
  double curvature_edges = 0.5;           ///< ...and gate beta above (this x rest edge)^2.
  int max_iterations = 100;
  bool kd_tree = true;                    ///< Count with PCL's kd-tree, as the paper does; else with the voxel grid. The counts are the same.
};

template <class Visitor>
void visit_fields(PaperContourOptions& o, Visitor&& field) {
  field("step_m", o.step_m, 0.0001, 0.01);
  field("search_share", o.search_share, 0.01, 2.0);
  field("max_search_m", o.max_search_m, 0.001, 0.5);
  field("density_radius_spacings", o.density_radius_spacings, 0.5, 10.0);
  field("continuity_edges", o.continuity_edges, 0.0, 100.0);
  field("curvature_edges", o.curvature_edges, 0.0, 100.0);
  field("max_iterations", o.max_iterations, 0, 1000);
  field("kd_tree", o.kd_tree);
}

/// Where a control point may go: along its normal (the paper), or along the 26 directions of a grid (Coc12b).
enum class ContourDirections { kNormal, kGrid26 };

/// The paper's active contour, literally (P17-P27): control points of the placed primitive step to where the scene's density begins,
/// held by gated internal energies relative to rest; regular points follow by the linear law; what sees no data stays generic.
/// @return method `gfp_paper` or `gfp_grid26`; closed as its primitive is. Nothing keeps it from crossing itself or the table:
///         the evidence and the scene's counts say so. `trace`, where given, takes how the contour ran.
FittedModel model_contour_paper(const ObjectView& view, const Placement& placement, const PaperContourOptions& options = {},
                                ContourDirections directions = ContourDirections::kNormal, ContourTrace* trace = nullptr);

/// The placed shape as it is, not deformed, as the model of `method`.
FittedModel model_placed(const ObjectView& view, const Placement& placement, const std::string& method);

/// The same contour from the sphere about the cluster, 610 points, all of them controls (the paper's comparison, P29). Needs no class;
/// looks as far as the sphere's centre. Method `sphere_snake`. A view without points gives a 20 mm ball 1 m away.
FittedModel fit_sphere_snake(const ObjectView& view, const PaperContourOptions& options = {}, ContourDirections directions = ContourDirections::kNormal,
                             ContourTrace* trace = nullptr);

}  // namespace gfp
