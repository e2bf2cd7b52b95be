// gfp primitive qa NAME: what a primitive promises, checked, with its pictures on a page.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/builtin_library.hpp"
#include "cli/commands.hpp"
#include "cli/primitive_commands.hpp"
#include "cli/primitive_report.hpp"
#include "evaluation/html_page.hpp"
#include "gfp/frame/png.hpp"

namespace gfp {
namespace {

using nlohmann::json;

struct QaArguments {
  std::string name, primitives, out = "qa";
  bool json = false;
};

struct Check {
  std::string name, found, expected;
  bool good = false;
};

/// Crossings of the mean moved two standard deviations either way along each mode.
int crossings_along_modes(const Primitive& primitive) {
  int crossings = 0;
  for (std::size_t k = 0; k < primitive.modes.size(); ++k)
    for (const double sigma : {-2.0, 2.0}) {
      std::vector<double> modes(k + 1, 0.0);
      modes[k] = sigma;
      crossings += count_self_intersections(shape_mesh(primitive, modes));
    }
  return crossings;
}

std::vector<Check> check(const Primitive& primitive) {
  const TriangleMesh mean = shape_mesh(primitive), filled{mean.vertices, primitive.topology->filled_triangles};
  const MeshTopology topology = examine_topology(mean);
  const int genus = (2 * topology.components - topology.euler_characteristic) / 2, crossings = count_self_intersections(mean), along = crossings_along_modes(primitive);
  const double volume_ml = 1e6 * signed_volume(mean), filled_ml = 1e6 * signed_volume(filled), low_mm = 1e3 * bounds(mean.vertices).low.z();
  const std::size_t controls = count_controls(primitive);
  return {{"watertight", topology.closed ? "yes" : fmt::format("{} open edges", topology.boundary_edges), "yes", topology.closed},
          {"components", std::to_string(topology.components), "1", topology.components == 1},
          {"genus", std::to_string(genus), std::to_string(primitive.genus), genus == primitive.genus},
          {"crossings of the mean", std::to_string(crossings), "0", crossings == 0},
          {"crossings at +-2 sigma", std::to_string(along), "0", along == 0},
          {"volume, ml", fmt::format("{:.1f}", volume_ml), "above 0", volume_ml > 0},
          {"volume filled, ml", fmt::format("{:.1f}", filled_ml), primitive.hollow ? "more than the material" : "the material", primitive.hollow ? filled_ml > volume_ml : filled_ml > 0},
          {"lowest point, mm", fmt::format("{:.2f}", low_mm), "within 1 of 0", std::abs(low_mm) <= 1},
          {"control points", std::to_string(controls), "at least 4", controls >= 4},
          {"stable poses", std::to_string(primitive.stable_poses.size()), "at least 1", !primitive.stable_poses.empty()},
          {"contact pairs", std::to_string(primitive.contact_pairs.size()), "at least 1", !primitive.contact_pairs.empty()}};
}

std::string page(const Primitive& primitive, const std::vector<Check>& checks) {
  std::string html = page_start("gfp primitive qa " + primitive.name) + "<table>";
  for (const Check& c : checks)
    html += "<tr><td>" + escaped(c.name) + "<td><b class=" + (c.good ? "good" : "bad") + ">" + escaped(c.found) + "</b><td>" + (c.good ? "" : "expected " + escaped(c.expected));
  html += "</table><figure><img src=\"" + escaped(primitive.name) + ".sheet.png\"><figcaption>Mean, control points (yellow; by hand: red), and each mode at -2, 0 and +2 sigma.</figcaption></figure>";
  return html + "<figure><img src=\"" + escaped(primitive.name) + ".symmetry.png\"><figcaption>Symmetry: " + escaped(symmetry_text(primitive.symmetry)) + ".</figcaption></figure>\n";
}

/// Whether all is well. Errors: kNotFound, those of library_with(), kIo.
Result<bool> run(const QaArguments& arguments) {
  const auto library = library_with(arguments.primitives);
  if (!library) return tl::unexpected(library.error());
  const auto found = find_class(*library, arguments.name);
  if (!found) return tl::unexpected(as_argument(found.error()));
  const Primitive& primitive = **found;
  const std::vector<Check> checks = check(primitive);
  const std::filesystem::path folder = arguments.out;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure(ErrorCode::kIo, "--out " + arguments.out + ": " + error.message());
  if (auto written = write_png(folder / (primitive.name + ".sheet.png"), draw_primitive(primitive)); !written) return tl::unexpected(written.error());
  if (auto written = write_png(folder / (primitive.name + ".symmetry.png"), draw_symmetry(primitive)); !written) return tl::unexpected(written.error());
  const auto file = folder / (primitive.name + ".html");
  if (auto written = write_text(file, page(primitive, checks)); !written) return tl::unexpected(written.error());
  bool good = true;
  json list = json::array();
  for (const Check& c : checks) {
    good = good && c.good;
    list.push_back({{"check", c.name}, {"found", c.found}, {"expected", c.expected}, {"good", c.good}});
    if (!arguments.json) std::cout << fmt::format("{:<24} {:<12} {}\n", c.name, c.found, c.good ? "" : "expected " + c.expected);
  }
  if (arguments.json) std::cout << json{{"primitive", primitive.name}, {"good", good}, {"checks", list}, {"page", file.string()}}.dump() << "\n";
  else std::cout << file.string() << "\n";
  return good;
}

}  // namespace

void add_primitive_qa_command(CLI::App& primitive, ExitStatus& status) {
  const auto arguments = std::make_shared<QaArguments>();
  CLI::App& command = *primitive.add_subcommand("qa", "Check what a primitive promises, and draw it on a page; exit code 65 where a check fails");
  command.add_option("NAME", arguments->name, "Name, class or alias")->required();
  command.add_option("--primitives", arguments->primitives, kPrimitivesHelp);
  command.add_option("--out", arguments->out, "Folder for NAME.html and its pictures")->capture_default_str();
  command.add_flag("--json", arguments->json, "Machine-readable output");
  command.callback([arguments, &status] {
    const auto good = run(*arguments);
    if (!good) return status.fail(std::cerr, arguments->name, good.error());
    if (!*good) status.fail(kExitDataError);
  });
}

}  // namespace gfp
