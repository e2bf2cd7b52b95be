#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "gfp/evaluation/summary.hpp"

namespace gfp {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class T>
Json number(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json coverage(const SigmaCoverage& c) { return Json{{"within", c.within}, {"vertices", c.vertices}}; }

Json method_json(const MethodResult& m) {
  const FitMetrics& f = m.metrics;
  return {{"class", m.class_name},
          {"class_correct", number(m.class_correct)},
          {"class_probability", m.class_probability},
          {"cost", m.cost},
          {"iou_filled", f.iou_filled},
          {"iou_material", f.iou_material},
          {"volume_error", number(f.volume_error)},
          {"chamfer_mm", number(1e3 * f.chamfer_m)},
          {"hidden_chamfer_mm", number(1e3 * f.hidden_chamfer_m)},
          {"observed_median_mm", number(1e3 * f.observed_median_m)},
          {"fscore_5mm", f.fscore_5mm},
          {"closed", f.closed},
          {"self_intersections", f.self_intersections},
          {"fit_similarity", f.fit_similarity},
          {"fit_similarity_true", f.fit_similarity_true},
          {"sigma_observed", coverage(f.sigma_observed)},
          {"sigma_inferred", coverage(f.sigma_inferred)},
          {"yaw_error_rad", number(f.yaw_error_rad)},
          {"grasp_success_1", number(m.grasp_success_1)},
          {"grasp_success_5", number(m.grasp_success_5)},
          {"ms", m.cpu_ms}};
}

Json case_json(const CaseResult& c) {
  Json methods = Json::object();
  for (const MethodResult& m : c.methods) methods[m.method] = method_json(m);
  return {{"source", c.source}, {"object", c.object}, {"view", c.view}, {"class", c.class_name}, {"hidden_share", c.hidden_share},
          {"segment_iou", c.segment_iou}, {"missed", c.missed}, {"methods", std::move(methods)}};
}

Json summary_json(const MethodSummary& s) {
  return {{"cases", s.cases},
          {"missed", s.missed},
          {"iou_filled_median", number(s.iou_filled_median)},
          {"iou_material_median", number(s.iou_material_median)},
          {"volume_error_median", number(s.volume_error_median)},
          {"chamfer_mm_median", number(s.chamfer_mm_median)},
          {"hidden_chamfer_mm_median", number(s.hidden_chamfer_mm_median)},
          {"observed_median_mm", number(s.observed_median_mm)},
          {"fscore_5mm", number(s.fscore_5mm)},
          {"closed_rate", number(s.closed_rate)},
          {"self_intersection_rate", number(s.self_intersection_rate)},
          {"fit_similarity_median", number(s.fit_similarity_median)},
          {"fit_similarity_gap_median", number(s.fit_similarity_gap_median)},
          {"sigma_coverage_observed", number(s.sigma_coverage_observed)},
          {"sigma_coverage_inferred", number(s.sigma_coverage_inferred)},
          {"class_accuracy", number(s.class_accuracy)},
          {"class_probability_mean", number(s.class_probability_mean)},
          {"yaw_error_deg_median", number(s.yaw_error_deg_median)},
          {"grasp_success_1", number(s.grasp_success_1)},
          {"grasp_success_5", number(s.grasp_success_5)},
          {"ms_median", number(s.ms_median)},
          {"ms_p99", number(s.ms_p99)}};
}

}  // namespace

std::string to_json(const EvaluationRecord& record) {
  Json cases = Json::array(), summary = Json::object();
  std::set<std::string> classes, sources;
  for (const CaseResult& c : record.cases) {
    cases.push_back(case_json(c));
    classes.insert(c.class_name);
    sources.insert(c.source);
  }
  for (std::size_t m = 0; m < record.methods.size(); ++m) {
    Json method = summary_json(summarise(record.cases, m));
    for (const std::string& name : classes) method["per_class"][name] = summary_json(summarise(record.cases, m, name));
    for (const std::string& name : sources) method["per_source"][name] = summary_json(summarise(record.cases, m, {}, name));
    summary[record.methods[m]] = std::move(method);
  }
  const Json all{{"machine", record.machine}, {"commit", record.commit}, {"seed", record.seed}, {"arguments", record.arguments},
                 {"cases", std::move(cases)}, {"summary", std::move(summary)}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gfp
