// gfp: the command-line tool. Each subcommand is one file beside this one.
#include <exception>
#include <iostream>
#include <string>

#include "cli/commands.hpp"
#include "gfp/core/version.hpp"

namespace {

int run(int argc, char** argv) {
  gfp::ExitStatus status;
  CLI::App app{"Closed, graspable object models from depth images", "gfp"};
  app.set_version_flag("--version", "gfp " + std::string(gfp::version()));
  app.require_subcommand(1);
  app.footer("Every command has --help and --json. Exit codes follow sysexits.h.");
  gfp::add_fit_command(app, status);
  gfp::add_eval_command(app, status);
  gfp::add_experiment_command(app, status);
  gfp::add_primitive_command(app, status);
  gfp::add_calibrate_command(app, status);
  gfp::add_config_command(app, status);
  gfp::add_devices_command(app, status);
  gfp::add_doctor_command(app, status);
  gfp::add_record_command(app, status);
  gfp::add_recorder_command(app, status);
  gfp::add_replay_command(app, status);
  gfp::add_repair_command(app, status);
  gfp::add_diff_command(app, status);
  gfp::add_echo_command(app, status);
  gfp::add_sub_command(app, status);
  gfp::add_top_command(app, status);
  gfp::add_key_command(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? gfp::kExitOk : gfp::kExitUsage;  // help and version are no errors
  }
  return status.code();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "gfp: " << error.what() << " (a bug: please report it)\n";
    return gfp::kExitSoftware;
  }
}
