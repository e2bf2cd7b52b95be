// gfp repair FILE: a recording that a kill, a power loss or a bad disk left behind becomes readable again.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "gfp/recording/repair.hpp"

namespace gfp {
namespace {

struct RepairArguments {
  std::string file, output;
  bool json = false;
};

const char* name_of(RepairReport::Outcome outcome) {
  switch (outcome) {
    case RepairReport::Outcome::kSound: return "sound";
    case RepairReport::Outcome::kClosed: return "closed";
    case RepairReport::Outcome::kLost: return "lost";
  }
  return "unknown";
}

/// `x.mcap.active` becomes `x.mcap`, unless that is there.
std::string without_active(const std::string& file) {
  if (!file.ends_with(".active")) return file;
  const std::string name = file.substr(0, file.size() - std::string_view(".active").size());
  std::error_code error;
  if (std::filesystem::exists(name, error)) return file;
  std::filesystem::rename(file, name, error);
  return error ? file : name;
}

void repair(const RepairArguments& arguments, ExitStatus& status) {
  const auto report = arguments.output.empty() ? repair_mcap(arguments.file) : repair_mcap_to(arguments.file, arguments.output);
  if (!report) return status.fail(std::cerr, "repair", report.error());
  const std::string file = arguments.output.empty() ? without_active(arguments.file) : arguments.output;
  if (report->outcome == RepairReport::Outcome::kLost) status.fail(kExitDataError);
  if (arguments.json) {
    nlohmann::ordered_json damage = nlohmann::ordered_json::array();
    for (const McapDamage& place : report->damage) damage.push_back({{"begin", place.begin}, {"end", place.end}, {"why", place.why}});
    const nlohmann::ordered_json line = {{"file", file}, {"outcome", name_of(report->outcome)}, {"messages", report->messages}, {"chunks", report->chunks}, {"damage", damage}};
    std::cout << line.dump() << std::endl;
    return;
  }
  std::cout << fmt::format("{}: {}, {} messages in {} chunks\n", file, name_of(report->outcome), report->messages, report->chunks);
  for (const McapDamage& place : report->damage) std::cout << fmt::format("  left out: bytes {} to {}: {}\n", place.begin, place.end, place.why);
}

}  // namespace

void add_repair_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("repair", "Makes a recording readable that was not closed or is damaged; exit code 65 where something was lost");
  const auto arguments = std::make_shared<RepairArguments>();
  command.add_option("FILE", arguments->file, "MCAP file, of any recorder")->required();
  command.add_option("--output", arguments->output, "Another file for the result; by default in place");
  command.add_flag("--json", arguments->json, "A JSON object");
  command.callback([arguments, &status] { repair(*arguments, status); });
}

}  // namespace gfp
