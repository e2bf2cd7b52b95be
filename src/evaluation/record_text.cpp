#include <cstdio>
#include <set>

#include "gfp/evaluation/summary.hpp"

namespace gfp {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string flag(const std::optional<bool>& value) { return value ? (*value ? "1" : "0") : ""; }

std::string line_of(const CaseResult& c, const MethodResult& m) {
  const FitMetrics& f = m.metrics;
  char numbers[512];
  std::snprintf(numbers, sizeof numbers, "%.4f,%.4f,%d,%.4f,%.4f,%.4f,%.3f,%.3f,%.3f,%.4f,%d,%d,%.4f,%.4f,%d,%d,%d,%d,%.2f", c.hidden_share, c.segment_iou,
                c.missed ? 1 : 0, f.iou_filled, f.iou_material, f.volume_error, 1e3 * f.chamfer_m, 1e3 * f.hidden_chamfer_m, 1e3 * f.observed_median_m,
                f.fscore_5mm, f.closed ? 1 : 0, f.self_intersections, f.fit_similarity, f.fit_similarity_true, f.sigma_observed.within,
                f.sigma_observed.vertices, f.sigma_inferred.within, f.sigma_inferred.vertices, m.cpu_ms);
  return quoted(c.source) + "," + quoted(c.object) + "," + quoted(c.view) + "," + quoted(c.class_name) + "," + m.method + "," + quoted(m.class_name) + "," +
         flag(m.class_correct) + "," + numbers + "," + (f.yaw_error_rad ? std::to_string(*f.yaw_error_rad) : "") + "," + flag(m.grasp_success_1) + "," +
         flag(m.grasp_success_5) + "\n";
}

std::string cell(const std::optional<double>& value, double factor, int digits) {
  char text[32] = "      -";
  if (value) std::snprintf(text, sizeof text, "%7.*f", digits, factor * *value);
  return text;
}

std::string text_line(const std::string& method, const std::string& name, const MethodSummary& s) {
  char head[96];
  std::snprintf(head, sizeof head, "%-18.18s %-14.14s %5d %5d ", method.c_str(), name.c_str(), s.cases, s.missed);
  return head + cell(s.iou_filled_median, 1, 3) + cell(s.volume_error_median, 100, 1) + cell(s.chamfer_mm_median, 1, 2) + cell(s.hidden_chamfer_mm_median, 1, 2) +
         cell(s.observed_median_mm, 1, 2) + cell(s.fscore_5mm, 1, 3) + cell(s.closed_rate, 100, 1) + cell(s.self_intersection_rate, 100, 1) +
         cell(s.fit_similarity_median, 1, 3) + cell(s.fit_similarity_gap_median, 1, 3) + cell(s.sigma_coverage_observed, 100, 0) +
         cell(s.sigma_coverage_inferred, 100, 0) + cell(s.class_accuracy, 100, 0) + cell(s.yaw_error_deg_median, 1, 1) + cell(s.grasp_success_1, 100, 0) +
         cell(s.grasp_success_5, 100, 0) + cell(s.ms_median, 1, 1) + cell(s.ms_p99, 1, 1) + "\n";
}

}  // namespace

std::string to_csv(const EvaluationRecord& record) {
  std::string text =
      "source,object,view,class,method,fit_class,class_correct,hidden_share,segment_iou,missed,iou_filled,iou_material,volume_error,chamfer_mm,"
      "hidden_chamfer_mm,observed_median_mm,fscore_5mm,closed,self_intersections,fit_similarity,fit_similarity_true,sigma_observed_within,"
      "sigma_observed_vertices,sigma_inferred_within,sigma_inferred_vertices,ms,yaw_error_rad,grasp_success_1,grasp_success_5\n";
  for (const CaseResult& c : record.cases)
    for (const MethodResult& m : c.methods) text += line_of(c, m);
  return text;
}

std::string to_text(const EvaluationRecord& record) {
  std::set<std::string> classes;
  for (const CaseResult& c : record.cases) classes.insert(c.class_name);
  std::string text = "method             class          cases  miss     IoU  dV[%]   Ch.mm  hid.mm obs.mm     F5mm closed%  selfX%    P28   P28gap  sig.o%  sig.i%  class%   yaw   gr@1%  gr@5%     ms  ms p99\n";
  for (std::size_t m = 0; m < record.methods.size(); ++m) {
    for (const std::string& name : classes) text += text_line(record.methods[m], name, summarise(record.cases, m, name));
    text += text_line(record.methods[m], "ALL", summarise(record.cases, m));
  }
  return text;
}

}  // namespace gfp
