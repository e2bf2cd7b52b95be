#include "gfp/evaluation/run_evaluation.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <utility>

#include "gfp/pipeline/fit_view.hpp"
#include "judge_plan.hpp"
#include "observe_case.hpp"
#include "thread_cpu_time.hpp"

namespace gfp {
namespace {

struct Fit {
  FittedModel model;
  double class_probability = 0;
  double cpu_ms = 0;
};

Result<Fit> fit_one(const ObjectView& view, const PrimitiveLibrary& library, const PipelineOptions& options) {
  Result<Fit> fit;
  tbb::this_task_arena::isolate([&] {  // or a waiting thread would take up another case inside the measured time
    const double begin = thread_cpu_ms();
    auto estimate = fit_object(view, library, options);
    if (!estimate) {
      fit = tl::unexpected(estimate.error());
      return;
    }
    fit->cpu_ms = thread_cpu_ms() - begin;
    if (!*estimate) return;
    fit->class_probability = (*estimate)->class_probabilities[(*estimate)->model.class_name];
    fit->model = std::move((*estimate)->model);
  });
  return fit;
}

class CaseRunner {
 public:
  CaseRunner(const PrimitiveLibrary& library, const EvaluationOptions& options, const EvaluationObserver& observer)
      : library_(library), options_(options), observer_(observer) {}

  Result<CaseResult> run(std::size_t index, const CaseSpec& spec) const {
    const Result<EvaluationCase> shown = spec.make();
    if (!shown) return tl::unexpected(Error{shown.error().code, spec.object + " " + spec.view + ": " + shown.error().what});
    const CaseObservation observation = observe_case(*shown, options_.pipeline, options_.mask_from_truth);
    CaseResult result{spec.source, spec.object, spec.view, spec.class_name, shown->hidden_share, observation.segment_iou, !observation.view, {}};
    std::vector<FittedModel> fits;
    for (const std::string& method : options_.methods) {
      Result<Fit> fit{};
      if (observation.view) fit = fit_one(*observation.view, library_, options_for(method, spec.class_name));
      if (!fit) return tl::unexpected(fit.error());
      result.methods.push_back(judge(method, spec.class_name, *shown, observation, *fit));
      fits.push_back(std::move(fit->model));
    }
    if (observer_.on_case) observer_.on_case(index, *shown, result, fits);
    return result;
  }

 private:
  PipelineOptions options_for(const std::string& method, const std::string& class_name) const {
    PipelineOptions pipeline = options_.pipeline;
    pipeline.method = method;
    const PrimitivePtr known = library_.find(class_name);
    pipeline.recognition.only_class = options_.class_known && known ? known->class_name : "";
    return pipeline;
  }

  MethodResult judge(const std::string& method, const std::string& class_name, const EvaluationCase& shown, const CaseObservation& observation, const Fit& fit) const {
    MethodResult result;
    result.method = method;
    result.metrics = measure_fit(shown.truth, fit.model, observation.points_camera);
    result.class_name = fit.model.class_name;
    result.class_probability = fit.class_probability;
    result.cost = fit.model.evidence.cost;
    if (const PrimitivePtr known = library_.find(class_name)) result.class_correct = fit.model.class_name == known->class_name;
    result.cpu_ms = fit.cpu_ms;
    if (options_.grasps) {
      const PlanVerdict verdict = observation.view ? judge_plan(fit.model, *observation.view, shown, options_.pipeline) : PlanVerdict{};
      result.grasp_success_1 = verdict.first;
      result.grasp_success_5 = verdict.any_of_five;
    }
    return result;
  }

  const PrimitiveLibrary& library_;
  const EvaluationOptions& options_;
  const EvaluationObserver& observer_;
};

}  // namespace

Result<std::vector<CaseResult>> run_evaluation(const std::vector<CaseSpec>& specs, const PrimitiveLibrary& library,
                                               const EvaluationOptions& options, const EvaluationObserver& observer) {
  for (const std::string& method : options.methods) {
    PipelineOptions pipeline = options.pipeline;
    pipeline.method = method;
    if (const auto known = validate(pipeline); !known) return tl::unexpected(known.error());
  }
  const CaseRunner runner(library, options, observer);
  std::vector<Result<CaseResult>> outcomes(specs.size());  // by case, whoever finishes first
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> failed = false;
  tbb::task_arena arena(options.jobs > 0 ? options.jobs : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, specs.size(), [&](std::size_t i) {
      if (failed) return;
      outcomes[i] = runner.run(i, specs[i]);
      if (!outcomes[i]) failed = true;
      if (observer.on_progress) observer.on_progress(++done, specs.size());
    }, tbb::simple_partitioner{});
  });
  std::vector<CaseResult> results;
  for (auto& outcome : outcomes) {
    if (!outcome) return tl::unexpected(outcome.error());
    results.push_back(std::move(*outcome));
  }
  return results;
}

}  // namespace gfp
