#pragma once

#include <CLI/CLI.hpp>

#include "cli/exit_code.hpp"

namespace gfp {

inline constexpr const char* kUpsamplingHelp = "How often the primitives' edges are halved: finer surfaces, more time";
inline constexpr const char* kPrimitivesHelp = "Folder of own primitives (gfp primitive build); a class there replaces the built-in one";

/// Each adds one subcommand to `app`; when the command runs (in a CLI11 callback), it says in `status` how it ended.
/// `status` lives as long as `app`.
void add_calibrate_command(CLI::App& app, ExitStatus& status);
void add_config_command(CLI::App& app, ExitStatus& status);
void add_devices_command(CLI::App& app, ExitStatus& status);
void add_doctor_command(CLI::App& app, ExitStatus& status);
void add_diff_command(CLI::App& app, ExitStatus& status);
void add_echo_command(CLI::App& app, ExitStatus& status);
void add_fit_command(CLI::App& app, ExitStatus& status);
void add_eval_command(CLI::App& app, ExitStatus& status);
void add_experiment_command(CLI::App& app, ExitStatus& status);
void add_key_command(CLI::App& app, ExitStatus& status);
void add_primitive_command(CLI::App& app, ExitStatus& status);
void add_record_command(CLI::App& app, ExitStatus& status);
void add_recorder_command(CLI::App& app, ExitStatus& status);
void add_repair_command(CLI::App& app, ExitStatus& status);
void add_replay_command(CLI::App& app, ExitStatus& status);
void add_sub_command(CLI::App& app, ExitStatus& status);
void add_top_command(CLI::App& app, ExitStatus& status);

}  // namespace gfp
