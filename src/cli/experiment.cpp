// gfp experiment: the paper's experiments, beside the numbers that it printed.
#include <iostream>
#include <memory>

#include "app/builtin_library.hpp"
#include "cli/commands.hpp"
#include "cli/progress_bar.hpp"
#include "gfp/evaluation/experiment.hpp"

namespace gfp {
namespace {

struct ExperimentArguments {
  std::string name, folder, report, primitives;
  int upsampling = 0;
  bool json = false;
  CaseOptions cases;
};

Result<void> run(const ExperimentArguments& arguments) {
  const auto library = library_with(arguments.primitives, arguments.upsampling);
  if (!library) return tl::unexpected(library.error());
  ProgressBar bar(std::cerr, "experiment");
  const auto experiment = run_experiment(arguments.name, *library, arguments.folder, arguments.cases, [&](std::size_t done, std::size_t total) { bar.show(done, total); });
  if (!experiment) return tl::unexpected(experiment.error());
  std::cout << (arguments.json ? to_json(*experiment, arguments.cases.seed) + "\n" : to_text(*experiment));
  if (arguments.report.empty()) return {};
  return write_experiment(*experiment, arguments.cases.seed, arguments.report);
}

}  // namespace

void add_experiment_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<ExperimentArguments>();
  ExperimentArguments& a = *arguments;
  a.cases.views = 2;
  CLI::App* experiment = app.add_subcommand("experiment", "Reproduce an experiment of the paper, beside the numbers that it printed");
  experiment->add_option("NAME", a.name, "mug (the contour against one from a sphere), shoe (Table 1), energy (Fig. 6) or speed")
      ->required()
      ->check(CLI::IsMember(experiment_names()));
  experiment->add_option("DIR", a.folder, "Known objects as for gfp eval; without it held-out members of the families");
  experiment->add_option("--primitives", a.primitives, kPrimitivesHelp);
  experiment->add_option("--upsampling", a.upsampling, kUpsamplingHelp)->check(CLI::Range(0, kMaxUpsampling))->capture_default_str();
  experiment->add_option("--views", a.cases.views, "Yaws per object and elevation")->check(CLI::Range(1, 360))->capture_default_str();
  experiment->add_option("--elevation", a.cases.elevations_deg, "Camera elevations above the table, degrees")->delimiter(',')->check(CLI::Range(5.0, 85.0))->capture_default_str();
  experiment->add_option("--instances", a.cases.instances, "Members per family")->check(CLI::Range(1, 1000))->capture_default_str();
  experiment->add_option("--seed", a.cases.seed, "Of noise, yaws and family members")->capture_default_str();
  experiment->add_option("--report", a.report, "Folder for a page with the table and plots, JSON and CSV");
  experiment->add_flag("--json", a.json, "JSON on standard output instead of a table");
  experiment->callback([arguments, &status] {
    if (const auto done = run(*arguments); !done) status.fail(std::cerr, "experiment", done.error());
  });
}

}  // namespace gfp
