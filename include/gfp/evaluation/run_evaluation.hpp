#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/evaluation/cases.hpp"
#include "gfp/evaluation/metrics.hpp"
#include "gfp/pipeline/pipeline_options.hpp"
#include "gfp/primitive/primitive_library.hpp"

namespace gfp {

struct EvaluationOptions {
  std::vector<std::string> methods{"gfp_robust"};
  bool class_known = true;       ///< The methods are told the class; an object without one (`other`) is always estimated.
  bool mask_from_truth = false;  ///< The object's pixels are given; otherwise the pipeline's own segmentation finds them.
  bool grasps = false;           ///< Plan on the fit, judge on the true object.
  int jobs = 0;                  ///< Cases at a time; 0: as many as there are cores.
  PipelineOptions pipeline;
};

/// One method on one case.
struct MethodResult {
  std::string method;
  FitMetrics metrics;
  std::string class_name;             ///< The fit's.
  std::optional<bool> class_correct;  ///< Empty where the library knows no such class.
  double class_probability = 0;       ///< That the fit's class is the right one, as the fit says.
  double cost = 0;                    ///< FitEvidence::cost.
  double cpu_ms = 0;                  ///< Of the fit, in its thread: recognition to selection.
  std::optional<bool> grasp_success_1, grasp_success_5;  ///< The best grasp, any of the best five, holds the true object.
};

/// One case under every method.
struct CaseResult {
  std::string source, object, view, class_name;
  double hidden_share = 0;
  double segment_iou = 0;             ///< Of the segment that was fitted with the object's readings.
  bool missed = false;                ///< No segment covers the object: every method has the worst metrics there are.
  std::vector<MethodResult> methods;  ///< In the order of EvaluationOptions::methods.
};

/// Who watches a run; called from several threads at once, once a case, in no particular order.
struct EvaluationObserver {
  std::function<void(std::size_t index, const EvaluationCase&, const CaseResult&, const std::vector<FittedModel>&)> on_case;
  std::function<void(std::size_t done, std::size_t total)> on_progress;
};

/// Runs every method on every case. The results are the same for any number of jobs, but for the times.
/// Errors: kNotFound (an unknown method, naming the known ones); those of CaseSpec::make, naming the case.
Result<std::vector<CaseResult>> run_evaluation(const std::vector<CaseSpec>& specs, const PrimitiveLibrary& library,
                                               const EvaluationOptions& options = {}, const EvaluationObserver& observer = {});

}  // namespace gfp
