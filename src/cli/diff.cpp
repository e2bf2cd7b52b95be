// gfp diff A B: which object differs in what, between two recordings or two runs of gfp fit. A regression test for robots.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/scene_diff.hpp"

namespace gfp {
namespace {

constexpr int kExitDifferent = 1;  ///< As diff(1) says it.

struct DiffArguments {
  std::string a, b;
  DiffTolerances tolerances;
  bool no_grasps = false, json = false;
};

nlohmann::ordered_json json_of(const Difference& difference) {
  nlohmann::ordered_json line = {{"frame", difference.frame}, {"stamp_ns", difference.stamp.count()}};
  line["id_a"] = difference.id_a ? nlohmann::ordered_json(*difference.id_a) : nlohmann::ordered_json();
  line["id_b"] = difference.id_b ? nlohmann::ordered_json(*difference.id_b) : nlohmann::ordered_json();
  line["what"] = difference.what;
  line["a"] = difference.a;
  line["b"] = difference.b;
  line["delta"] = difference.delta;
  line["tolerance"] = difference.tolerance;
  return line;
}

void print(const Difference& difference) {
  const std::string id = difference.id_a ? std::to_string(*difference.id_a) : difference.id_b ? std::to_string(*difference.id_b) : "-";
  std::cout << fmt::format("frame {:<5} object {:<4} {:<18} {} | {}", difference.frame, id, difference.what, difference.a.empty() ? "nothing" : difference.a,
                           difference.b.empty() ? "nothing" : difference.b);
  if (difference.tolerance > 0) std::cout << fmt::format("  ({:.3g}, at most {:.3g})", difference.delta, difference.tolerance);
  std::cout << "\n";
}

void diff(const DiffArguments& arguments, ExitStatus& status) {
  const auto a = load_scenes(arguments.a);
  if (!a) return status.fail(std::cerr, arguments.a, a.error());
  const auto b = load_scenes(arguments.b);
  if (!b) return status.fail(std::cerr, arguments.b, b.error());
  const auto differences = compare_scenes(*a, *b, arguments.tolerances);
  if (arguments.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Difference& difference : differences) list.push_back(json_of(difference));
    const nlohmann::ordered_json line = {{"frames_a", a->size()}, {"frames_b", b->size()}, {"differences", std::move(list)}};
    std::cout << line.dump() << std::endl;
  } else {
    for (const Difference& difference : differences) print(difference);
    std::cout << fmt::format("{} differences between {} and {} frames\n", differences.size(), a->size(), b->size());
  }
  if (!differences.empty()) status.fail(kExitDifferent);
}

}  // namespace

void add_diff_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("diff", "Compares the objects of two recordings, or of two outputs of gfp fit --json; exit code 1 where they differ");
  const auto arguments = std::make_shared<DiffArguments>();
  DiffTolerances& tolerances = arguments->tolerances;
  command.add_option("A", arguments->a, ".mcap, or JSON lines")->required();
  command.add_option("B", arguments->b, "The other one")->required();
  command.add_option("--position", tolerances.position_m, "Metres that an object or grasp may have moved")->capture_default_str();
  command.add_option("--angle", tolerances.angle_rad, "Radians that it may have turned")->capture_default_str();
  command.add_option("--size", tolerances.size_m, "Metres that an extent may have changed")->capture_default_str();
  command.add_option("--vertex", tolerances.vertex_m, "Metres that a vertex may have moved in its object")->capture_default_str();
  command.add_option("--width", tolerances.width_m, "Metres that a grasp's opening may have changed")->capture_default_str();
  command.add_option("--epsilon", tolerances.epsilon, "That a grasp's quality may have changed")->capture_default_str();
  command.add_flag("--no-grasps", arguments->no_grasps, "Grasps are not compared");
  command.add_flag("--json", arguments->json, "A JSON object");
  command.callback([arguments, &status] {
    arguments->tolerances.grasps = !arguments->no_grasps;
    diff(*arguments, status);
  });
}

}  // namespace gfp
