// gfp config check FILE | schema | effective [FILE]: the configuration of gfpd, without starting it.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "config/daemon_options.hpp"

namespace gfp {
namespace {

struct ConfigArguments {
  std::string file;
  std::vector<std::string> settings;
  bool json = false;
};

/// The options, or the problems on standard error and exit code 78.
std::optional<DaemonOptions> load(const ConfigArguments& arguments, ExitStatus& status) {
  auto options = config::load_daemon_options(arguments.file, arguments.settings);
  if (!options) {
    if (arguments.json) std::cout << nlohmann::json{{"ok", false}, {"problems", options.error().what}}.dump() << "\n";
    else std::cerr << options.error().what << "\n";
    status.fail(options.error().code == ErrorCode::kNotFound ? kExitNoInput : kExitConfig);
    return std::nullopt;
  }
  return std::move(*options);
}

void check(const ConfigArguments& arguments, ExitStatus& status) {
  const auto options = load(arguments, status);
  if (!options) return;
  if (arguments.json) std::cout << nlohmann::json{{"ok", true}, {"sensors", options->sensors.size()}}.dump() << "\n";
  else std::cout << arguments.file << ": ok, " << options->sensors.size() << " sensor(s)\n";
}

void effective(const ConfigArguments& arguments, ExitStatus& status) {
  if (const auto options = load(arguments, status)) std::cout << config::to_yaml(*options);
}

}  // namespace

void add_config_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<ConfigArguments>();
  CLI::App* command = app.add_subcommand("config", "Checks, describes and completes configurations of gfpd");
  command->require_subcommand(1);
  CLI::App* check_command = command->add_subcommand("check", "Says what is wrong with a configuration, a line a problem");
  check_command->add_option("FILE", arguments->file)->required();
  check_command->add_flag("--json", arguments->json);
  CLI::App* effective_command = command->add_subcommand("effective", "Every option with its value: defaults, file, --set");
  effective_command->add_option("FILE", arguments->file);
  for (CLI::App* one : {check_command, effective_command}) one->add_option("--set", arguments->settings, "path.to.key=value; may be repeated")->take_all();
  check_command->callback([arguments, &status] { check(*arguments, status); });
  effective_command->callback([arguments, &status] { effective(*arguments, status); });
  command->add_subcommand("schema", "JSON Schema of the configuration: keys, types, defaults, bounds")->callback([] { std::cout << config::schema_json() << "\n"; });
}

}  // namespace gfp
