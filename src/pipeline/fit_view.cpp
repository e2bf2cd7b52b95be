#include "gfp/pipeline/fit_view.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "gfp/modelling/fit_superquadric.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/recognition/recognise.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "pipeline/methods.hpp"

namespace gfp {
namespace {

constexpr const char* kSuperquadric = "superquadric";

/// A placement with what was believed of its class before.
struct Placed {
  Placement placement;
  double log_prior = 0;
};

std::vector<Placed> place_all(const ObjectView& view, const std::vector<Hypothesis>& hypotheses, const RegistrationOptions& options) {
  std::vector<Placed> all;
  for (const Hypothesis& hypothesis : hypotheses)
    for (Placement& placement : register_primitive(view, hypothesis, options)) all.push_back({std::move(placement), hypothesis.log_prior});
  return all;
}

/// The contour is the dear part: only the placements of least cost get one.
void keep_best(std::vector<Placed>& all, int count) {
  std::stable_sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.placement.cost < b.placement.cost; });
  if (all.size() > static_cast<std::size_t>(count)) all.resize(static_cast<std::size_t>(count));
}

std::vector<Candidate> contour_all(const ObjectView& view, const std::vector<Placed>& all, const ModellingOptions& options) {
  std::vector<Candidate> candidates;
  for (const Placed& placed : all) candidates.push_back({model_contour(view, placed.placement, options), placed.log_prior});
  return candidates;
}

std::vector<Candidate> search(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  const auto hypotheses = timings.measure("recognition", [&] { return recognise(view, library, options.recognition); });
  auto placed = timings.measure("registration", [&] { return place_all(view, hypotheses, options.registration); });
  keep_best(placed, options.budget.max_contours);
  auto candidates = timings.measure("modelling", [&] { return contour_all(view, placed, options.modelling); });
  auto superquadric = timings.measure(kSuperquadric, [&] { return fit_superquadric(view); });
  candidates.push_back({std::move(superquadric), 0.0});  // what `unknown` is worth beforehand is for selection to say
  return candidates;
}

/// Follows what the object was in the last frame; nothing where that can't be followed.
std::vector<Candidate> track(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  if (view.warm_start->method == kSuperquadric) return fit_superquadric_only(view, library, options, timings);
  const Hypothesis known{library.find(view.warm_start->class_name), 0.0, {}};
  if (!known.primitive) return {};
  auto placed = timings.measure("registration", [&] { return place_all(view, {known}, options.registration); });
  keep_best(placed, 1);
  return timings.measure("modelling", [&] { return contour_all(view, placed, options.modelling); });
}

bool is_as_good_as(const WarmStart& before, const std::vector<Candidate>& candidates, double slack) {
  return !candidates.empty() && candidates.front().model.evidence.cost <= before.cost + slack;
}

}  // namespace

bool is_tracked(const ObjectView& view, const FitBudgetOptions& options) {
  return view.warm_start && view.warm_start->fits % options.search_every != 0;
}

std::vector<Candidate> fit_gfp_robust(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  if (is_tracked(view, options.budget)) {
    auto candidates = track(view, library, options, timings);
    if (is_as_good_as(*view.warm_start, candidates, options.budget.warm_cost_slack)) return candidates;
  }
  return search(view, library, options, timings);
}

std::vector<Candidate> fit_superquadric_only(const ObjectView& view, const PrimitiveLibrary&, const PipelineOptions&, StageTimings& timings) {
  return {{timings.measure(kSuperquadric, [&] { return fit_superquadric(view); }), 0.0}};
}

Result<std::vector<Candidate>> fit_view(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings* timings) {
  const Result<Method> method = find_method(options.method);
  if (!method) return tl::unexpected(method.error());
  StageTimings unused;
  return method->fit(view, library, options, timings ? *timings : unused);
}

}  // namespace gfp
