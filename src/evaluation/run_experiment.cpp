#include <tbb/task_arena.h>

#include <algorithm>

#include "gfp/evaluation/experiment.hpp"
#include "gfp/evaluation/metrics.hpp"
#include "gfp/evaluation/run_evaluation.hpp"
#include "gfp/modelling/model_contour.hpp"
#include "gfp/modelling/model_contour_paper.hpp"
#include "gfp/pipeline/fit_view.hpp"
#include "gfp/registration/register_primitive.hpp"
#include "median.hpp"
#include "observe_case.hpp"
#include "thread_cpu_time.hpp"

namespace gfp {
namespace {

/// One way of fitting: `place` is not timed, `fit` is.
struct Way {
  std::string name;
  std::function<FittedModel(const ObjectView&, const PrimitiveLibrary&, const PrimitivePtr&, const Placement&)> fit;
  std::string paper;
};

struct Plan {
  std::string_view name;
  std::string question, class_name, timed;
  bool placed = false;  ///< Whether the ways start from one placement, which is registered beforehand.
  bool curves = false;
  std::vector<Way> ways;
};

/// A whole method, from recognition (the class is told) to selection.
Way method(const std::string& name, const std::string& paper) {
  return {name,
          [name](const ObjectView& view, const PrimitiveLibrary& library, const PrimitivePtr& primitive, const Placement&) {
            PipelineOptions options;
            options.method = name;
            options.recognition.only_class = primitive->class_name;
            auto estimate = fit_object(view, library, options);
            return estimate && *estimate ? std::move((*estimate)->model) : FittedModel{};
          },
          paper};
}

Way contour(const std::string& name, ContourDirections directions, bool kd_tree, const std::string& paper) {
  return {name,
          [=](const ObjectView& view, const PrimitiveLibrary&, const PrimitivePtr&, const Placement& placement) {
            return model_contour_paper(view, placement, {.kd_tree = kd_tree}, directions);
          },
          paper};
}

Way sphere(const std::string& name, ContourDirections directions, bool kd_tree, const std::string& paper) {
  return {name, [=](const ObjectView& view, const PrimitiveLibrary&, const PrimitivePtr&, const Placement&) { return fit_sphere_snake(view, {.kd_tree = kd_tree}, directions); }, paper};
}

Way robust_contour() {
  return {"gfp_robust's contour", [](const ObjectView& view, const PrimitiveLibrary&, const PrimitivePtr&, const Placement& placement) { return model_contour(view, placement); }, ""};
}

std::vector<Plan> plans() {
  using enum ContourDirections;
  const std::vector<Way> contours{contour("gfp, +-normal", kNormal, false, "410 points, 107 + 96 moved, 21 iterations, 680 ms"),
                                  contour("gfp, +-normal, kd-tree", kNormal, true, ""),
                                  contour("gfp, 26 directions, kd-tree", kGrid26, true, ""),
                                  sphere("sphere, +-normal", kNormal, false, ""),
                                  sphere("sphere, +-normal, kd-tree", kNormal, true, ""),
                                  sphere("sphere, 26 directions, kd-tree", kGrid26, true, "38 iterations, 9 s"),
                                  robust_contour()};
  std::vector<Way> all;
  for (const std::string& name : method_names()) all.push_back(method(name, name == "gfp_paper" ? "0.7 to 1.5 s" : name == "superquadric" ? "4.79 s" : ""));
  return {{"mug", "The contour of a generic mug needs half the iterations and a thirteenth of the time of one that starts from a sphere (P29).", "mug",
           "the contour, from one registered placement or from the cluster's sphere", true, true, contours},
          {"shoe", "A generic shoe fits better and faster than a superquadric (Table 1, P30).", "shoe", "the whole fit, the class told", false, false,
           {method("superquadric", "4.79 s, fit 0.7689"), method("multi_superquadric", ""), method("gfp_paper", "1.53 s, fit 0.9762"),
            method("gfp_robust", "")}},
          {"energy", "The energy falls to its minimum in fewer iterations from a generic primitive than from a sphere (Fig. 6, P29).", "mug",
           "the contour, from one registered placement or from the cluster's sphere", true, true, {contours[0], contours[3]}},
          {"speed", "A generic primitive is fitted in 0.7 to 1.5 s (P29, P30).", "", "the whole fit, the class told", false, false, all}};
}

/// What one way gave on one view.
struct Outcome {
  FittedModel model;
  FitMetrics metrics;
  double cpu_ms = 0;
};

template <class Figure>
double median_of(const std::vector<Outcome>& outcomes, Figure&& figure) {
  std::vector<double> values;
  for (const Outcome& outcome : outcomes) values.push_back(figure(outcome));
  return median(std::move(values));
}

ExperimentRow row_of(const Way& way, bool contour, const std::vector<Outcome>& outcomes) {
  const auto with = [](const FittedModel& model, bool control) {
    return static_cast<double>(std::count_if(model.states.begin(), model.states.end(), [&](std::uint8_t s) { return (s & kVertexMoved) != 0 && ((s & kVertexControl) != 0) == control; }));
  };
  ExperimentRow row;
  row.name = way.name;
  row.paper = way.paper;
  row.views = static_cast<int>(outcomes.size());
  row.points = median_of(outcomes, [](const Outcome& o) { return static_cast<double>(o.model.vertices.size()); });
  if (contour) {
    row.moved_controls = median_of(outcomes, [&](const Outcome& o) { return with(o.model, true); });
    row.moved_regulars = median_of(outcomes, [&](const Outcome& o) { return with(o.model, false); });
    row.iterations = median_of(outcomes, [](const Outcome& o) { return static_cast<double>(o.model.iterations); });
  }
  row.cpu_ms = median_of(outcomes, [](const Outcome& o) { return o.cpu_ms; });
  row.fit_similarity = median_of(outcomes, [](const Outcome& o) { return o.metrics.fit_similarity; });
  row.iou_filled = median_of(outcomes, [](const Outcome& o) { return o.metrics.iou_filled; });
  row.volume_error = median_of(outcomes, [](const Outcome& o) { return o.metrics.volume_error; });
  row.self_crossing_share = static_cast<double>(std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return o.metrics.self_intersections > 0; })) /
                            static_cast<double>(std::max<std::size_t>(1, outcomes.size()));
  return row;
}

Result<std::vector<CaseSpec>> cases_of(const Plan& plan, const std::filesystem::path& folder, const CaseOptions& options, const PrimitiveLibrary& library) {
  auto specs = folder.empty() ? list_family_cases(options) : list_folder_cases(folder, options);
  if (!specs) return specs;
  std::erase_if(*specs, [&](const CaseSpec& spec) {
    const PrimitivePtr known = library.find(spec.class_name);
    return !known || (!plan.class_name.empty() && known->class_name != plan.class_name);
  });
  if (specs->empty()) return failure(ErrorCode::kNotFound, "objects of the class " + plan.class_name + " = 0, expected at least 1");
  return specs;
}

}  // namespace

std::vector<std::string> experiment_names() {
  std::vector<std::string> names;
  for (const Plan& plan : plans()) names.emplace_back(plan.name);
  return names;
}

Result<Experiment> run_experiment(std::string_view name, const PrimitiveLibrary& library, const std::filesystem::path& folder, CaseOptions options,
                                  const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::vector<Plan> all = plans();
  const auto plan = std::find_if(all.begin(), all.end(), [&](const Plan& p) { return p.name == name; });
  std::string known;
  for (const Plan& p : all) known += (known.empty() ? " " : ", ") + std::string(p.name);
  if (plan == all.end()) return failure(ErrorCode::kNotFound, "experiment = " + std::string(name) + ", expected one of" + known);
  options.only.clear();
  const auto specs = cases_of(*plan, folder, options, library);
  if (!specs) return tl::unexpected(specs.error());

  std::vector<std::vector<Outcome>> outcomes(plan->ways.size());
  int missed = 0;
  tbb::task_arena one_core(1);
  for (std::size_t c = 0; c < specs->size(); ++c) {
    const CaseSpec& spec = (*specs)[c];
    const auto shown = spec.make();
    if (!shown) return tl::unexpected(Error{shown.error().code, spec.object + " " + spec.view + ": " + shown.error().what});
    const CaseObservation observation = observe_case(*shown, {}, false);
    if (observation.view) {
      const PrimitivePtr primitive = library.find(spec.class_name);
      const Placement placement = plan->placed ? register_primitive(*observation.view, {primitive, 0.0, {}}).front() : Placement{};
      for (std::size_t w = 0; w < plan->ways.size(); ++w) {
        Outcome outcome;
        one_core.execute([&] {
          const double begin = thread_cpu_ms();
          outcome.model = plan->ways[w].fit(*observation.view, library, primitive, placement);
          outcome.cpu_ms = thread_cpu_ms() - begin;
        });
        outcome.metrics = measure_fit(shown->truth, outcome.model, observation.points_camera);
        outcomes[w].push_back(std::move(outcome));
      }
    } else {
      ++missed;
    }
    if (progress) progress(c + 1, specs->size());
  }

  Experiment experiment{std::string(plan->name), plan->question, std::to_string(specs->size() - static_cast<std::size_t>(missed)) + " views of " +
                        (plan->class_name.empty() ? "every class" : plan->class_name) + (folder.empty() ? ", held-out family members" : ", " + folder.lexically_normal().filename().string()) +
                        (missed > 0 ? " (" + std::to_string(missed) + " not found by the segmentation)" : ""), plan->timed, {}, {}};
  for (std::size_t w = 0; w < plan->ways.size(); ++w) {
    const Way& way = plan->ways[w];
    experiment.rows.push_back(row_of(way, plan->placed, outcomes[w]));
    if (plan->curves && !outcomes[w].empty() && !outcomes[w].front().model.energies.empty()) experiment.curves.push_back({way.name, outcomes[w].front().model.energies});
  }
  return experiment;
}

}  // namespace gfp
