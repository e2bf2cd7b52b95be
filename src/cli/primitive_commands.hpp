#pragma once

#include <CLI/CLI.hpp>

#include "cli/exit_code.hpp"

namespace gfp {

/// Subcommands of `gfp primitive` with a file of their own; as in commands.hpp.
void add_primitive_build_command(CLI::App& primitive, ExitStatus& status);
void add_primitive_qa_command(CLI::App& primitive, ExitStatus& status);
void add_primitive_retype_command(CLI::App& primitive, ExitStatus& status);

}  // namespace gfp
