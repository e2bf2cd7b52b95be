#include "gfp/evaluation/summary.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr double kDegrees = 57.29577951308232;

// Lower of the two middle values where their number is even: always a value that was measured.
std::optional<double> quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  const std::size_t rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return std::isfinite(*place) ? std::optional(*place) : std::nullopt;
}

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::optional<double> share(const SigmaCoverage& pooled) {
  if (pooled.vertices == 0) return std::nullopt;
  return static_cast<double>(pooled.within) / pooled.vertices;
}

/// The columns of a summary, as they are collected.
struct Columns {
  std::vector<double> iou_filled, iou_material, volume_error, chamfer, hidden, observed, fscore, similarity, gap, yaw, ms;
  std::vector<double> closed, intersecting, correct, class_probability, grasp_1, grasp_5;
  SigmaCoverage sigma_observed, sigma_inferred;
};

void pool(const SigmaCoverage& part, SigmaCoverage& all) {
  all.within += part.within;
  all.vertices += part.vertices;
}

void add(const MethodResult& fit, bool missed, Columns& columns) {
  const FitMetrics& m = fit.metrics;
  columns.iou_filled.push_back(m.iou_filled);
  columns.iou_material.push_back(m.iou_material);
  columns.volume_error.push_back(m.volume_error);
  columns.chamfer.push_back(1e3 * m.chamfer_m);
  columns.hidden.push_back(1e3 * m.hidden_chamfer_m);
  columns.observed.push_back(1e3 * m.observed_median_m);
  columns.fscore.push_back(m.fscore_5mm);
  columns.similarity.push_back(m.fit_similarity);
  columns.gap.push_back(m.fit_similarity_true - m.fit_similarity);
  if (m.yaw_error_rad) columns.yaw.push_back(kDegrees * *m.yaw_error_rad);
  if (fit.class_correct) {
    columns.correct.push_back(*fit.class_correct ? 1 : 0);
    columns.class_probability.push_back(fit.class_probability);
  }
  if (fit.grasp_success_1) columns.grasp_1.push_back(*fit.grasp_success_1 ? 1 : 0);
  if (fit.grasp_success_5) columns.grasp_5.push_back(*fit.grasp_success_5 ? 1 : 0);
  if (missed) return;  // no fit, no mesh
  columns.closed.push_back(m.closed ? 1 : 0);
  columns.intersecting.push_back(m.self_intersections > 0 ? 1 : 0);
  columns.ms.push_back(fit.cpu_ms);
  pool(m.sigma_observed, columns.sigma_observed);
  pool(m.sigma_inferred, columns.sigma_inferred);
}

}  // namespace

MethodSummary summarise(const std::vector<CaseResult>& results, std::size_t method, const std::string& class_name, const std::string& source) {
  MethodSummary summary;
  Columns columns;
  for (const CaseResult& result : results) {
    if (!class_name.empty() && result.class_name != class_name) continue;
    if (!source.empty() && result.source != source) continue;
    ++summary.cases;
    summary.missed += result.missed ? 1 : 0;
    add(result.methods[method], result.missed, columns);
  }
  summary.iou_filled_median = quantile(columns.iou_filled, 0.5);
  summary.iou_material_median = quantile(columns.iou_material, 0.5);
  summary.volume_error_median = quantile(columns.volume_error, 0.5);
  summary.chamfer_mm_median = quantile(columns.chamfer, 0.5);
  summary.hidden_chamfer_mm_median = quantile(columns.hidden, 0.5);
  summary.observed_median_mm = quantile(columns.observed, 0.5);
  summary.fscore_5mm = mean(columns.fscore);
  summary.closed_rate = mean(columns.closed);
  summary.self_intersection_rate = mean(columns.intersecting);
  summary.fit_similarity_median = quantile(columns.similarity, 0.5);
  summary.fit_similarity_gap_median = quantile(columns.gap, 0.5);
  summary.sigma_coverage_observed = share(columns.sigma_observed);
  summary.sigma_coverage_inferred = share(columns.sigma_inferred);
  summary.class_accuracy = mean(columns.correct);
  summary.class_probability_mean = mean(columns.class_probability);
  summary.yaw_error_deg_median = quantile(columns.yaw, 0.5);
  summary.grasp_success_1 = mean(columns.grasp_1);
  summary.grasp_success_5 = mean(columns.grasp_5);
  summary.ms_median = quantile(columns.ms, 0.5);
  summary.ms_p99 = quantile(columns.ms, 0.99);
  return summary;
}

}  // namespace gfp
