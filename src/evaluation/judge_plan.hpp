#pragma once

#include "gfp/evaluation/cases.hpp"
#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/pipeline/pipeline_options.hpp"

namespace gfp {

/// Whether the best grasp, and whether any of the best five, would hold the true object.
struct PlanVerdict {
  bool first = false, any_of_five = false;
};

/// Plans on the fit with what the view knows of its surroundings (support, readings of other things), and judges on the true
/// object among the true others. No grasp is no success.
PlanVerdict judge_plan(const FittedModel& fit, const ObjectView& view, const EvaluationCase& shown, const PipelineOptions& options);

}  // namespace gfp
