// gfp primitive retype NAME: a person's word on which vertices are control points (P7), kept apart from the automatic typing.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/retype_primitive.hpp"
#include "cli/primitive_commands.hpp"
#include "cli/primitive_report.hpp"
#include "gfp/primitive/type_points.hpp"

namespace gfp {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 8> kParts{"body", "base", "rim", "inner_wall", "handle", "neck", "cap", "spout"};  // as Part numbers them

struct RetypeArguments {
  std::string name, primitives, set, vertices, part;
  std::vector<double> box_m;
  bool list = false, json = false;
};

const char* type_name(PointType type) { return type == PointType::kControl ? "control" : "regular"; }

/// `3,7-9` as a flag a vertex.
Result<std::vector<bool>> parse_vertices(const std::string& text, std::size_t count) {
  std::vector<bool> chosen(count, false);
  const char *at = text.data(), *end = at + text.size();
  const auto wrong = [&] { return failure(ErrorCode::kInvalidArgument, fmt::format("--vertices {}: expected indices in [0, {}) and ranges, as in 3,7-9", text.substr(0, 80), count)); };
  while (at != end) {
    std::size_t first = 0;
    auto parsed = std::from_chars(at, end, first);
    if (parsed.ec != std::errc{}) return wrong();
    std::size_t last = first;
    if (parsed.ptr != end && *parsed.ptr == '-') {
      parsed = std::from_chars(parsed.ptr + 1, end, last);
      if (parsed.ec != std::errc{}) return wrong();
    }
    if (first > last || last >= count) return wrong();
    for (std::size_t i = first; i <= last; ++i) chosen[i] = true;
    at = parsed.ptr;
    if (at == end) break;
    if (*at != ',' || ++at == end) return wrong();
  }
  return chosen;
}

/// The vertices of which everything holds that was asked: indices, box, part; all where nothing was.
Result<std::vector<bool>> selected(const RetypeArguments& arguments, const Primitive& primitive, const std::vector<Eigen::Vector3d>& points) {
  std::vector<bool> chosen(primitive.size(), true);
  if (!arguments.vertices.empty()) {
    auto parsed = parse_vertices(arguments.vertices, primitive.size());
    if (!parsed) return parsed;
    chosen = std::move(*parsed);
  }
  const auto& box = arguments.box_m;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (std::size_t axis = 0; axis < 3 && !box.empty(); ++axis) {
      const double value = points[i][static_cast<Eigen::Index>(axis)];
      if (value < box[axis] || value > box[axis + 3]) chosen[i] = false;
    }
    if (!arguments.part.empty() && arguments.part != kParts[static_cast<std::size_t>(primitive.topology->parts[i])]) chosen[i] = false;
  }
  if (std::none_of(chosen.begin(), chosen.end(), [](bool c) { return c; })) return failure(ErrorCode::kInvalidArgument, "0 vertices selected, expected at least 1");
  return chosen;
}

/// What `--set` says.
std::optional<PointType> type_of(const std::string& set) {
  if (set == "control") return PointType::kControl;
  if (set == "regular") return PointType::kRegular;
  return std::nullopt;
}

json manual_json(const Primitive& primitive, const std::vector<Eigen::Vector3d>& points) {
  const auto automatic = type_points({points, primitive.topology->triangles}).types;
  json list = json::array();
  for (std::size_t i = 0; i < primitive.manual_types.size(); ++i) {
    if (!primitive.manual_types[i]) continue;
    list.push_back({{"vertex", i},
                    {"type", type_name(*primitive.manual_types[i])},
                    {"automatic", type_name(automatic[i])},
                    {"part", kParts[static_cast<std::size_t>(primitive.topology->parts[i])]},
                    {"point_m", {points[i].x(), points[i].y(), points[i].z()}}});
  }
  return list;
}

void print(const json& result, bool list) {
  std::cout << fmt::format("{}: {} changed, {} set by hand, {} control points\n", result["primitive"].get<std::string>(), result["changed"].get<int>(), result["manual"].size(),
                           result["control_points"].get<std::size_t>());
  if (!list) return;
  for (const json& entry : result["manual"])
    std::cout << fmt::format("  vertex {:>5}  {} (by itself {})  {}  {:.1f} {:.1f} {:.1f} mm\n", entry["vertex"].get<int>(), entry["type"].get<std::string>(), entry["automatic"].get<std::string>(),
                             entry["part"].get<std::string>(), 1e3 * entry["point_m"][0].get<double>(), 1e3 * entry["point_m"][1].get<double>(), 1e3 * entry["point_m"][2].get<double>());
}

Result<json> run(const RetypeArguments& arguments) {
  auto primitive = primitive_to_retype(arguments.primitives, arguments.name);
  if (!primitive) return tl::unexpected(primitive.error().code == ErrorCode::kNotFound ? as_argument(primitive.error()) : primitive.error());
  const std::vector<Eigen::Vector3d> points = shape(*primitive, primitive->typical_size_m());
  json result{{"primitive", primitive->name}, {"file", nullptr}, {"changed", 0}};
  if (!arguments.set.empty()) {
    if (arguments.set != "auto" && arguments.vertices.empty() && arguments.box_m.empty() && arguments.part.empty())
      return failure(ErrorCode::kInvalidArgument, "--set " + arguments.set + ": expected --vertices, --box or --part beside it");
    const auto chosen = selected(arguments, *primitive, points);
    if (!chosen) return tl::unexpected(chosen.error());
    result["changed"] = set_types_by_hand(*chosen, type_of(arguments.set), *primitive);
    const auto file = keep_primitive(arguments.primitives, *primitive);
    if (!file) return tl::unexpected(file.error());
    result["file"] = file->string();
  }
  result["manual"] = manual_json(*primitive, points);
  result["control_points"] = count_controls(*primitive);
  return result;
}

}  // namespace

void add_primitive_retype_command(CLI::App& primitive, ExitStatus& status) {
  const auto arguments = std::make_shared<RetypeArguments>();
  RetypeArguments& a = *arguments;
  CLI::App& command = *primitive.add_subcommand("retype", "Say which vertices are control points, by hand: kept apart from the automatic typing, and through a new build");
  command.add_option("NAME", a.name, "Of a primitive in the folder; of a built-in one, a copy is put there")->required();
  auto* folder = command.add_option("--primitives", a.primitives, "Folder of own primitives, as gfp primitive build makes it");
  auto* set = command.add_option("--set", a.set, "What the selected vertices become; auto: what they are by themselves (without a selection: all)")->check(CLI::IsMember({"control", "regular", "auto"}))->needs(folder);
  command.add_option("--vertices", a.vertices, "Indices and ranges, as in 3,7-9")->needs(set);
  command.add_option("--box", a.box_m, "x0,y0,z0,x1,y1,z1: vertices of the typical shape inside it, metres, object frame")->delimiter(',')->expected(6)->needs(set);
  command.add_option("--part", a.part, "Vertices of this part; several selections together: what all of them hold")->check(CLI::IsMember(std::vector<std::string>(kParts.begin(), kParts.end())))->needs(set);
  command.add_flag("--list", a.list, "Every vertex that was set by hand");
  command.add_flag("--json", a.json, "Machine-readable output");
  command.callback([arguments, &status] {
    const auto result = run(*arguments);
    if (!result) return status.fail(std::cerr, arguments->name, result.error());
    if (arguments->json) std::cout << result->dump() << "\n";
    else print(*result, arguments->list || arguments->set.empty());
  });
}

}  // namespace gfp
