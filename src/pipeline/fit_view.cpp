#include "gfp/pipeline/fit_view.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "gfp/memory/image_score.hpp"
#include "gfp/modelling/fit_superquadric.hpp"
#include "gfp/modelling/follow_model.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/recognition/recognise.hpp"
#include "gfp/registration/follow_shape.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "gfp/selection/select_models.hpp"
#include "pipeline/methods.hpp"

namespace gfp {
namespace {

constexpr double kContourGain = 0.2;  ///< Cost by which a contour may improve one placement more than another.
constexpr double kToldOtherwise = -20.0;  ///< Log prior of "none of the classes" beside what it always is, where the class was told.
constexpr const char* kSuperquadric = "superquadric";

/// The contour is the dear part: only the best placements get one, and those that it may still bring to the front.
std::vector<Candidate> contour_best(const ObjectView& view, const std::vector<Hypothesis>& hypotheses, const std::vector<Placement>& placements, int count,
                                    const ModellingOptions& options) {
  std::size_t worth = 0;
  while (worth < std::min(placements.size(), static_cast<std::size_t>(count)) && placements[worth].cost < placements.front().cost + kContourGain) ++worth;
  std::vector<Candidate> candidates(worth);
  oneapi::tbb::parallel_for(std::size_t{0}, worth, [&](std::size_t k) {
    candidates[k] = {model_contour(view, placements[k], options), hypotheses[static_cast<std::size_t>(placements[k].hypothesis)].log_prior};
  });
  return candidates;
}

std::vector<Candidate> place_and_contour(const ObjectView& view, const std::vector<Hypothesis>& hypotheses, int contours, const PipelineOptions& options,
                                         StageTimings& timings) {
  const auto placements = timings.measure("registration", [&] { return register_hypotheses(view, hypotheses, options.registration); });
  return timings.measure("modelling", [&] { return contour_best(view, hypotheses, placements, contours, options.modelling); });
}

std::vector<Candidate> search(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  const auto hypotheses = timings.measure("recognition", [&] { return recognise(view, library, options.recognition); });
  auto candidates = place_and_contour(view, hypotheses, options.budget.max_contours, options, timings);
  if (unknown_may_win(candidates, options.selection)) {
    auto superquadric = timings.measure(kSuperquadric, [&] { return fit_superquadric(view); });
    const bool told = !options.recognition.only_class.empty();
    if (!told) std::erase_if(candidates, [](const Candidate& c) { return c.model.evidence.cost > kMostlyUnexplained; });
    candidates.push_back({std::move(superquadric), told ? kToldOtherwise : 0.0});
  }
  return candidates;
}

/// Whether it is this fit's turn. Objects that came together take turns, so that no frame has to do it for all of them.
bool is_due(const ObjectView& view, int every) { return (static_cast<std::uint64_t>(view.warm_start->fits) + 7 * view.id) % static_cast<std::uint64_t>(every) == 0; }

/// The last frame's shape where it is now; nothing where it is due to be fitted again, or is no longer right.
std::optional<FittedModel> follow(const ObjectView& view, const PipelineOptions& options, StageTimings& timings) {
  const WarmStart& warm = *view.warm_start;
  if (!warm.model || is_due(view, options.budget.reshape_every)) return std::nullopt;
  const FollowedPose pose = timings.measure(
      "registration", [&] { return follow_shape(view, warm.model->vertices, warm.model->topology, warm.T_camera_object, options.registration); });
  FittedModel model = timings.measure("modelling", [&] { return follow_model(view, *warm.model, pose); });
  if (model.evidence.cost > warm.cost + options.budget.shape_cost_slack) return std::nullopt;
  return model;
}

/// What the object was in the last frame, shaped anew; nothing where that can't be followed.
std::vector<Candidate> reshape(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  if (view.warm_start->method == kSuperquadric) return fit_superquadric_only(view, library, options, timings);
  const Hypothesis known{library.find(view.warm_start->primitive), 0.0, {}};
  if (!known.primitive) return {};
  return place_and_contour(view, {known}, 1, options, timings);
}

bool is_as_good_as(const WarmStart& before, const std::vector<Candidate>& candidates, double slack) {
  return !candidates.empty() && candidates.front().model.evidence.cost <= before.cost + slack;
}

}  // namespace

bool is_tracked(const ObjectView& view, const FitBudgetOptions& options) {
  return view.warm_start && !is_due(view, options.search_every);
}

std::vector<Candidate> fit_gfp_robust(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings& timings) {
  if (is_tracked(view, options.budget)) {
    if (auto model = follow(view, options, timings)) return {{std::move(*model), 0.0}};
    auto candidates = reshape(view, library, options, timings);
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

Result<std::optional<ObjectEstimate>> fit_object(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options, StageTimings* timings) {
  auto candidates = fit_view(view, library, options, timings);
  if (!candidates) return tl::unexpected(candidates.error());
  if (candidates->empty()) return std::nullopt;
  return std::move(select_models({view}, {std::move(*candidates)}, options.selection).front());
}

}  // namespace gfp
