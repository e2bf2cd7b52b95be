// gfp doctor: whether this machine is fit for sensors, with a line to fix what is not.
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/examine_machine.hpp"
#include "cli/commands.hpp"

namespace gfp {
namespace {

void print(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    std::cout << to_string(finding.level) << ": " << finding.check << ": " << finding.what << "\n";
    if (!finding.fix.empty()) std::cout << "    fix: " << finding.fix << "\n";
  }
}

nlohmann::json to_json(const std::vector<Finding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const Finding& finding : findings) list.push_back({{"check", finding.check}, {"level", to_string(finding.level)}, {"what", finding.what}, {"fix", finding.fix.empty() ? nlohmann::json() : nlohmann::json(finding.fix)}});
  return {{"findings", list}};
}

}  // namespace

void add_doctor_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("doctor", "Say whether this machine is fit for sensors, and how to make it so");
  const auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "One JSON document");
  command.footer("Exit code 69 where there is a problem; warnings alone are 0.");
  command.callback([json, &status] {
    const auto findings = examine_machine("/", current_user());
    if (*json) std::cout << to_json(findings).dump(2) << "\n";
    else print(findings);
    for (const Finding& finding : findings)
      if (finding.level == Finding::Level::kProblem) status.fail(kExitUnavailable);
  });
}

}  // namespace gfp
