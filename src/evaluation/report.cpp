#include "gfp/evaluation/report.hpp"

#include <cmath>
#include <cstdio>

#include "case_picture.hpp"
#include "gfp/frame/png.hpp"
#include "html_page.hpp"

namespace gfp {
namespace {

// Sorts the figures of the page by the first method's IoU, or back into the order of the run.
constexpr const char* kScript =
    "function sortBy(key){const box=document.getElementById('cases');"
    "[...box.children].sort((a,b)=>a.dataset[key]-b.dataset[key]).forEach(f=>box.appendChild(f))}";

std::string picture_name(std::size_t index) {
  char name[32];
  std::snprintf(name, sizeof name, "cases/%05zu.png", index);
  return name;
}

std::string caption(const CaseResult& c) {
  std::string text = "<b>" + escaped(c.object) + "</b> (" + escaped(c.class_name) + ") " + escaped(c.view);
  if (c.hidden_share > 0) text += "  hidden " + std::to_string(std::lround(100 * c.hidden_share)) + " %";
  if (c.missed) return text + "  <b class=bad>missed</b>";
  for (const MethodResult& m : c.methods) {
    char line[256];
    std::snprintf(line, sizeof line, "\n%-18s <b class=%s>IoU %.3f</b>  dV %4.1f %%  Chamfer %5.2f mm  hidden %5.2f mm  seen %4.2f mm  P28 %.3f of %.3f  %s%.1f ms",
                  m.method.c_str(), m.metrics.iou_filled >= 0.75 ? "good" : "bad", m.metrics.iou_filled, 100 * m.metrics.volume_error, 1e3 * m.metrics.chamfer_m,
                  1e3 * m.metrics.hidden_chamfer_m, 1e3 * m.metrics.observed_median_m, m.metrics.fit_similarity, m.metrics.fit_similarity_true,
                  m.metrics.closed ? "" : "OPEN ", m.cpu_ms);
    text += line + std::string("  as ") + escaped(m.class_name);
  }
  return text;
}

std::string page(const EvaluationRecord& record) {
  std::string html = page_start("gfp eval", kScript);
  html += "<p>" + escaped(record.arguments) + "<br>" + escaped(record.machine) + ", commit " + escaped(record.commit) + ", seed " + std::to_string(record.seed) + "</p>";
  html += "<pre>" + escaped(to_text(record)) + "</pre>";
  html += "<p>Tiles: depth (object tinted); true object from the camera, from behind; per method (";
  for (std::size_t m = 0; m < record.methods.size(); ++m) html += (m > 0 ? ", " : "") + escaped(record.methods[m]);
  html += "): fit (blue observed, orange inferred), signed error from the camera and from behind (red outside, blue inside, full colour at 10 mm).</p>";
  html += "<p><button onclick=\"sortBy('iou')\">worst first</button><button onclick=\"sortBy('index')\">in order</button></p><div id=cases>";
  for (std::size_t i = 0; i < record.cases.size(); ++i) {
    const CaseResult& c = record.cases[i];
    const double iou = c.methods.empty() ? 0 : c.methods.front().metrics.iou_filled;
    html += "\n<figure data-index=" + std::to_string(i) + " data-iou=" + std::to_string(iou) + "><figcaption>" + caption(c) + "</figcaption><img loading=lazy src=\"" + picture_name(i) + "\"></figure>";
  }
  return html + "</div>\n";
}

}  // namespace

Result<EvaluationReport> EvaluationReport::create(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder / "cases", error);
  if (error) return failure(ErrorCode::kIo, folder.string() + ": " + error.message());
  return EvaluationReport(folder);
}

Result<void> EvaluationReport::draw(std::size_t index, const EvaluationCase& shown, const std::vector<FittedModel>& fits) const {
  return write_png(folder_ / picture_name(index), draw_case(shown, fits));
}

Result<void> EvaluationReport::finish(const EvaluationRecord& record) const {
  if (auto written = write_text(folder_ / "cases.json", to_json(record)); !written) return written;
  if (auto written = write_text(folder_ / "cases.csv", to_csv(record)); !written) return written;
  return write_text(folder_ / "index.html", page(record));
}

}  // namespace gfp
