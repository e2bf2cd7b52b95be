#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gfp/evaluation/run_evaluation.hpp"

namespace gfp {

/// One method over many cases. A missed object counts as the worst fit there is: IoU 0, infinite distances, no grasp.
/// Empty where the number does not exist (no such case, or the median is infinite).
struct MethodSummary {
  int cases = 0, missed = 0;
  std::optional<double> iou_filled_median, iou_material_median, volume_error_median;
  std::optional<double> chamfer_mm_median, hidden_chamfer_mm_median, observed_median_mm;
  std::optional<double> fscore_5mm;                ///< Mean.
  std::optional<double> closed_rate, self_intersection_rate;  ///< Of the fits.
  std::optional<double> fit_similarity_median, fit_similarity_gap_median;  ///< Gap: the true mesh's own score less the fit's.
  std::optional<double> sigma_coverage_observed, sigma_coverage_inferred;  ///< Pooled over all vertices.
  std::optional<double> class_accuracy;
  std::optional<double> class_probability_mean;    ///< Of the same cases, as the fits say: calibrated where it is the accuracy.
  std::optional<double> yaw_error_deg_median;
  std::optional<double> grasp_success_1, grasp_success_5;
  std::optional<double> ms_median, ms_p99;         ///< CPU time of a fit.
};

/// What `results` say about the method with index `method`, over the cases of one class or source (empty: of all).
MethodSummary summarise(const std::vector<CaseResult>& results, std::size_t method, const std::string& class_name = {}, const std::string& source = {});

/// A whole run, as it is written.
struct EvaluationRecord {
  std::string machine;  ///< Processor and number of cores.
  std::string commit;
  std::uint64_t seed = 0;
  std::vector<std::string> methods;
  std::string arguments;  ///< How it was asked for, for people.
  std::vector<CaseResult> cases;
};

std::string machine_name();    ///< As in `Intel(R) Xeon(R) CPU, 2 cores`.
std::string source_commit();   ///< Of the working tree this was built from, `-dirty` where it had changes; `unknown` outside git.

/// JSON as the command-line contract has it: {machine, commit, seed, cases, summary{method{..., per_class, per_source}}}.
std::string to_json(const EvaluationRecord& record);
/// One line per case and method.
std::string to_csv(const EvaluationRecord& record);
/// A table for people: one line per method and class.
std::string to_text(const EvaluationRecord& record);

}  // namespace gfp
