#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "gfp/evaluation/experiment.hpp"
#include "gfp/evaluation/summary.hpp"
#include "html_page.hpp"

namespace gfp {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 10> kColumns{"points", "controls", "regulars", "iterations", "ms", "P28 fit", "IoU", "dV[%]", "selfX[%]", "the paper"};
constexpr std::array<const char*, 8> kColours{"#1663a6", "#d2691e", "#2e7d32", "#8e24aa", "#00838f", "#c62828", "#827717", "#5d4037"};

std::string number(const std::optional<double>& value, const char* format) {
  if (!value) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, *value);
  return text;
}

/// In the order of kColumns.
std::array<std::string, 10> cells(const ExperimentRow& row) {
  return {number(row.points, "%.0f"), number(row.moved_controls, "%.0f"), number(row.moved_regulars, "%.0f"), number(row.iterations, "%.0f"), number(row.cpu_ms, "%.2f"),
          number(row.fit_similarity, "%.4f"), number(row.iou_filled, "%.3f"), number(100 * row.volume_error, "%.1f"), number(100 * row.self_crossing_share, "%.0f"), row.paper};
}

std::string padded(const std::string& text, std::size_t width, bool left = false) {
  const std::string space(width > text.size() ? width - text.size() : 0, ' ');
  return left ? text + space : space + text;
}

/// A curve's energies as shares of its first.
std::vector<double> relative(const EnergyCurve& curve) {
  std::vector<double> values = curve.energies;
  const double first = values.empty() || !(values.front() > 0) ? 1.0 : values.front();
  for (double& value : values) value /= first;
  return values;
}

/// Energies over iterations, each as a share of its start.
std::string plot(const std::vector<EnergyCurve>& curves) {
  constexpr double kWidth = 720, kHeight = 360, kLeft = 60, kBottom = 40, kTop = 24, kRight = 15;
  std::size_t longest = 2;
  double highest = 1;
  for (const EnergyCurve& curve : curves) {
    longest = std::max(longest, curve.energies.size());
    for (const double value : relative(curve)) highest = std::max(highest, value);
  }
  const auto x = [&](double iteration) { return kLeft + (kWidth - kLeft - kRight) * iteration / static_cast<double>(longest - 1); };
  const auto y = [&](double share) { return kTop + (kHeight - kTop - kBottom) * (1 - share / highest); };
  const auto text = [](double at_x, double at_y, const char* anchor, const std::string& words, const char* colour = "#444") {
    return "<text x=" + number(at_x, "%.1f") + " y=" + number(at_y, "%.1f") + " font-size=12 text-anchor=" + anchor + " fill=\"" + colour + "\">" + escaped(words) + "</text>";
  };
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=" + number(kWidth, "%.0f") + " height=" + number(kHeight, "%.0f") + " role=img aria-label=\"energy over iterations\">";
  for (int tick = 0; tick <= 4; ++tick) {
    const double share = highest * tick / 4, iteration = std::round(static_cast<double>(longest - 1) * tick / 4);
    svg += "<line x1=" + number(kLeft, "%.1f") + " x2=" + number(kWidth - kRight, "%.1f") + " y1=" + number(y(share), "%.1f") + " y2=" + number(y(share), "%.1f") + " stroke=\"#ddd\"/>";
    svg += text(kLeft - 6, y(share) + 4, "end", number(share, "%.2f")) + text(x(iteration), kHeight - kBottom + 18, "middle", number(iteration, "%.0f"));
  }
  svg += text(0.5 * (kLeft + kWidth), kHeight - 6, "middle", "iteration") + text(kLeft, kTop - 10, "start", "energy, share of its start (gfp_robust's contour has an energy of its own)");
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const char* colour = kColours[c % kColours.size()];
    const auto values = relative(curves[c]);
    svg += "<polyline fill=none stroke-width=2 stroke=\"" + std::string(colour) + "\" points=\"";
    for (std::size_t k = 0; k < values.size(); ++k) svg += number(x(static_cast<double>(k)), "%.1f") + "," + number(y(values[k]), "%.1f") + " ";
    svg += "\"/>" + text(kWidth - kRight - 6, kTop + 12 + 17 * static_cast<double>(c), "end", curves[c].name + ", " + std::to_string(values.size() - 1) + " iterations", colour);
  }
  return svg + "</svg>";
}

std::string page(const Experiment& experiment, std::uint64_t seed) {
  std::string html = page_start("gfp experiment " + experiment.name);
  html += "<p>" + escaped(experiment.question) + "<br>" + escaped(experiment.views) + ". Timed: " + escaped(experiment.timed) + "; one core, medians.<br>" + escaped(machine_name()) +
          ", commit " + escaped(source_commit()) + ", seed " + std::to_string(seed) + "</p><table cellpadding=5 style=\"border-collapse:collapse\"><tr><th align=left>way</th>";
  for (const char* column : kColumns) html += "<th align=right>" + escaped(column) + "</th>";
  for (const ExperimentRow& row : experiment.rows) {
    html += "</tr>\n<tr style=\"border-top:1px solid #ddd\"><td>" + escaped(row.name) + "</td>";
    for (const std::string& cell : cells(row)) html += "<td align=right>" + escaped(cell) + "</td>";
  }
  html += "</tr></table>";
  if (!experiment.curves.empty()) html += "<h2>Energy over iterations (first view)</h2>" + plot(experiment.curves);
  return html + "<p>P28 fit: mean of 1 / (1 + (d / 5 mm)^2) over the seen points; IoU and dV of the filled volume against the true object.</p>\n";
}

std::string csv(const std::vector<EnergyCurve>& curves) {
  std::string text = "way,iteration,energy\n";
  for (const EnergyCurve& curve : curves)
    for (std::size_t k = 0; k < curve.energies.size(); ++k) text += "\"" + curve.name + "\"," + std::to_string(k) + "," + number(curve.energies[k], "%.6g") + "\n";
  return text;
}

}  // namespace

std::string to_text(const Experiment& experiment) {
  constexpr std::size_t kName = 32, kCell = 11;
  std::string text = experiment.question;
  text += "\n" + experiment.views + ". Timed: " + experiment.timed + "; one core, medians.\n" + padded("", kName);
  for (std::size_t c = 0; c + 1 < kColumns.size(); ++c) text += padded(kColumns[c], kCell);
  text += "  ";
  text += kColumns.back();
  text += "\n";
  for (const ExperimentRow& row : experiment.rows) {
    text += padded(row.name, kName, true);
    const auto values = cells(row);
    for (std::size_t c = 0; c + 1 < values.size(); ++c) text += padded(values[c], kCell);
    text += "  " + values.back() + "\n";
  }
  for (const EnergyCurve& curve : experiment.curves) {
    text += "energy, ";
    text += curve.name;
    text += ":";
    for (const double value : relative(curve)) text += number(value, " %.3f");
    text += "\n";
  }
  return text;
}

std::string to_json(const Experiment& experiment, std::uint64_t seed) {
  const auto optional = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json rows = Json::array(), curves = Json::array();
  for (const ExperimentRow& row : experiment.rows)
    rows.push_back({{"name", row.name},
                    {"views", row.views},
                    {"points", optional(row.points)},
                    {"moved_controls", optional(row.moved_controls)},
                    {"moved_regulars", optional(row.moved_regulars)},
                    {"iterations", optional(row.iterations)},
                    {"ms", row.cpu_ms},
                    {"fit_similarity", row.fit_similarity},
                    {"iou_filled", row.iou_filled},
                    {"volume_error", row.volume_error},
                    {"self_crossing_share", row.self_crossing_share},
                    {"paper", row.paper}});
  for (const EnergyCurve& curve : experiment.curves) curves.push_back({{"name", curve.name}, {"energies", curve.energies}});
  return Json{{"experiment", experiment.name}, {"question", experiment.question}, {"machine", machine_name()}, {"commit", source_commit()}, {"seed", seed}, {"views", experiment.views},
              {"timed", experiment.timed}, {"rows", std::move(rows)}, {"curves", std::move(curves)}}
      .dump(2);
}

Result<void> write_experiment(const Experiment& experiment, std::uint64_t seed, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure(ErrorCode::kIo, folder.string() + ": " + error.message());
  if (auto written = write_text(folder / "experiment.json", to_json(experiment, seed)); !written) return written;
  if (!experiment.curves.empty())
    if (auto written = write_text(folder / "curves.csv", csv(experiment.curves)); !written) return written;
  return write_text(folder / "index.html", page(experiment, seed));
}

}  // namespace gfp
