#include "cli/collection_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/primitive_report.hpp"
#include "evaluation/html_page.hpp"
#include "gfp/frame/png.hpp"

namespace gfp {
namespace {

using nlohmann::json;

std::string member_picture(const std::string& name, std::size_t index) { return fmt::format("{}/member_{:03}.png", name, index); }

std::string figure(const std::string& picture, const std::string& caption) {
  return "\n<figure><img loading=lazy src=\"" + escaped(picture) + "\"><figcaption>" + caption + "</figcaption></figure>";
}

std::string member_figure(const std::string& class_name, std::size_t index, const json& member) {
  const std::string reason = member.at("reason").is_null() ? "" : member.at("reason").get<std::string>();
  std::string caption = "<b>" + escaped(member.at("name")) + "</b>\n";
  if (!reason.empty()) caption += "<b class=bad>left out:</b> " + escaped(reason) + "\n";
  const json& size = member.at("size_m");
  caption += fmt::format("residual {:.4f}, genus {}, {:.0f} x {:.0f} x {:.0f} mm, {:.1f} ml", member.at("residual").get<double>(), member.at("genus").get<int>(),
                         1e3 * size[0].get<double>(), 1e3 * size[1].get<double>(), 1e3 * size[2].get<double>(), 1e6 * member.at("volume_m3").get<double>());
  return figure(member_picture(class_name, index), caption);
}

Symmetry symmetry_of(const json& symmetry) {
  return {symmetry.at("revolution"), symmetry.at("cyclic"), symmetry.at("mirror_x"), symmetry.at("mirror_y"), symmetry.at("flip_z")};
}

std::string class_section(const json& record) {
  const std::string name = record.at("class");
  std::string html = "\n<h2 id=\"" + escaped(name) + "\">" + escaped(name) + "</h2>";
  if (record.at("primitive").is_null()) {
    html += "<p><b class=bad>refused:</b> " + escaped(record.at("reason")) + "</p>";
  } else {
    const json& primitive = record.at("primitive");
    html += fmt::format("<p>{} points ({} control), genus {}, {}, {} modes, {} of {} members (template: {}), {:.1f} s, typing {:.1f} ms</p>", primitive.at("vertices").get<int>(),
                        primitive.at("control_points").get<int>(), primitive.at("genus").get<int>(), primitive.at("hollow").get<bool>() ? "hollow" : "solid",
                        primitive.at("modes").get<int>(), primitive.at("provenance").at("members").get<int>(), record.at("members").size(), escaped(record.at("template")), record.at("seconds").get<double>(),
                        record.at("typing_ms").get<double>());
    if (const double moved = record.at("mean_moved").get<double>(); moved > 1e-6)
      html += fmt::format("<p>The plain average crosses itself: the mean was kept from it by at most {:.3f} of its size.</p>", moved);
    html += "<div class=row>";
    html += figure(name + "/symmetry.png", "Symmetry: " + escaped(symmetry_text(symmetry_of(primitive.at("symmetry")))) + ". Red: axis; green: mirror planes.");
    html += "</div><figure><img loading=lazy src=\"" + escaped(name) + "/sheet.png\"><figcaption>Mean, control points (yellow), and each mode at -2, 0 and +2 sigma.</figcaption></figure>";
  }
  html += "<div class=row>";
  for (std::size_t k = 0; k < record.at("members").size(); ++k) html += member_figure(name, k, record.at("members")[k]);
  return html + "</div>";
}

}  // namespace

Result<void> draw_class(const std::filesystem::path& folder, const std::string& name, const Primitive* primitive, const std::vector<MemberReport>& members) {
  constexpr Rgb8 kKept{120, 170, 220}, kLeftOut{200, 110, 100};
  std::error_code error;
  std::filesystem::create_directories(folder / name, error);
  if (error) return failure(ErrorCode::kIo, (folder / name).string() + ": " + error.message());
  if (primitive) {
    if (auto written = write_png(folder / name / "sheet.png", draw_primitive(*primitive)); !written) return written;
    if (auto written = write_png(folder / name / "symmetry.png", draw_symmetry(*primitive)); !written) return written;
  }
  for (std::size_t k = 0; k < members.size(); ++k) {
    const bool kept = members[k].rejected.empty();
    const std::string caption = kept ? fmt::format("residual {:.4f}", members[k].residual) : "left out";
    if (auto written = write_png(folder / member_picture(name, k), draw_body(members[k].surface, caption, kept ? kKept : kLeftOut)); !written) return written;
  }
  return {};
}

Result<void> write_collection_page(const std::filesystem::path& folder, const json& classes) {
  std::string html = page_start("gfp primitive build") + "<p>";
  for (const json& record : classes) {
    const std::string name = escaped(record.at("class"));
    html += "<a href=\"#" + name + "\">" + name + "</a>" + (record.at("primitive").is_null() ? " (refused) " : " ");
  }
  html += "</p><p>Members are drawn as they were averaged: closed, and turned as the primitive is; blue ones are part of it.</p>";
  for (const json& record : classes) html += class_section(record);
  return write_text(folder / "index.html", html + "\n");
}

}  // namespace gfp
