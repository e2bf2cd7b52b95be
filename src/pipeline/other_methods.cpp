// The methods that the paper is, or compares itself with (P31).
#include "gfp/modelling/fit_multi_superquadric.hpp"
#include "gfp/modelling/fit_simple_primitive.hpp"
#include "gfp/modelling/model_contour_paper.hpp"
#include "gfp/recognition/recognise.hpp"
#include "gfp/registration/register_paper.hpp"
#include "gfp/registration/retrieve_instance.hpp"
#include "pipeline/methods.hpp"

namespace gfp {
namespace {

/// The paper's order: the class is decided before anything is fitted (P4), then one registration and one contour.
std::vector<Candidate> fit_by_class(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, ContourDirections directions,
                                    StageTimings& timings) {
  const auto hypotheses = timings.measure("recognition", [&] { return recognise(view, library, options.recognition); });
  if (hypotheses.empty()) return {};
  const Hypothesis& hypothesis = hypotheses.front();
  const Placement placement = timings.measure("registration", [&] { return register_paper(view, hypothesis, options.paper.registration); });
  return {{timings.measure("modelling", [&] { return model_contour_paper(view, placement, options.paper.contour, directions); }), hypothesis.log_prior}};
}

}  // namespace

std::vector<Candidate> fit_gfp_paper(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  return fit_by_class(view, library, options, ContourDirections::kNormal, timings);
}

std::vector<Candidate> fit_gfp_grid26(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  return fit_by_class(view, library, options, ContourDirections::kGrid26, timings);
}

std::vector<Candidate> fit_sphere_snake_only(const ObjectView& view, const PrimitiveLibrary&, const PipelineOptions& options, StageTimings& timings) {
  return {{timings.measure("modelling", [&] { return fit_sphere_snake(view, options.paper.contour); }), 0.0}};
}

std::vector<Candidate> fit_multi_superquadric_only(const ObjectView& view, const PrimitiveLibrary&, const PipelineOptions&, StageTimings& timings) {
  return {{timings.measure("modelling", [&] { return fit_multi_superquadric(view); }), 0.0}};
}

std::vector<Candidate> fit_simple_primitive_only(const ObjectView& view, const PrimitiveLibrary&, const PipelineOptions&, StageTimings& timings) {
  return {{timings.measure("modelling", [&] { return fit_simple_primitive(view); }), 0.0}};
}

std::vector<Candidate> fit_nearest_instance(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  const auto hypotheses = timings.measure("recognition", [&] { return recognise(view, library, options.recognition); });
  const Placement placement = timings.measure("registration", [&] { return retrieve_instance(view, hypotheses); });
  if (!placement.primitive) return {};
  return {{timings.measure("modelling", [&] { return model_placed(view, placement, "nearest_instance"); }), 0.0}};
}

}  // namespace gfp
