// gfp eval: how well the methods recover the true volume of known objects.
#include <iostream>
#include <iterator>
#include <memory>
#include <mutex>
#include <sstream>

#include "app/builtin_library.hpp"
#include "cli/commands.hpp"
#include "cli/progress_bar.hpp"
#include "gfp/evaluation/report.hpp"
#include "gfp/evaluation/run_evaluation.hpp"

namespace gfp {
namespace {

struct EvalArguments {
  std::vector<std::string> folders;
  bool families = false, class_known = false, class_estimated = false, json = false;
  std::string noise = "kinect", mask = "segmented", report, primitives;
  int upsampling = 0;
  CaseOptions cases;
  EvaluationOptions evaluation;
};

std::string describe(const EvalArguments& a) {
  std::ostringstream text;
  for (const std::string& folder : a.folders) text << std::filesystem::path(folder).lexically_normal().filename().string() << ' ';
  if (a.families) text << "families (" << a.cases.instances << " instances, free form " << a.cases.free_form << ") ";
  text << "class " << (a.class_estimated ? "estimated" : "known") << ", mask " << a.mask << ", views " << a.cases.views << ", elevation";
  for (const double elevation : a.cases.elevations_deg) text << ' ' << elevation;
  if (a.cases.cameras > 1) text << ", cameras " << a.cases.cameras;
  text << ", occlusion " << a.cases.occlusion << ", noise " << a.noise;
  if (a.upsampling > 0) text << ", upsampling " << a.upsampling;
  if (!a.primitives.empty()) text << ", own primitives " << std::filesystem::path(a.primitives).lexically_normal().filename().string();
  if (!a.cases.only.empty()) text << ", only " << a.cases.only;
  return text.str();
}

Result<std::vector<CaseSpec>> list_cases(const EvalArguments& arguments) {
  std::vector<CaseSpec> specs;
  const auto add = [&](Result<std::vector<CaseSpec>> more) -> Result<void> {
    if (!more) return tl::unexpected(more.error());
    std::move(more->begin(), more->end(), std::back_inserter(specs));
    return {};
  };
  for (const std::string& folder : arguments.folders)
    if (auto added = add(list_folder_cases(folder, arguments.cases)); !added) return tl::unexpected(added.error());
  if (arguments.families)
    if (auto added = add(list_family_cases(arguments.cases)); !added) return tl::unexpected(added.error());
  if (specs.empty()) return failure(ErrorCode::kNotFound, "0 cases, expected at least 1 (--only " + arguments.cases.only + ")");
  return specs;
}

Result<EvaluationRecord> evaluate(const EvalArguments& arguments, const std::vector<CaseSpec>& specs, const EvaluationReport* report) {
  ProgressBar bar(std::cerr, "eval");
  std::mutex mutex;
  Result<void> drawn;
  EvaluationObserver observer;
  observer.on_progress = [&](std::size_t done, std::size_t total) { bar.show(done, total); };
  if (report)
    observer.on_case = [&](std::size_t index, const EvaluationCase& shown, const CaseResult&, const std::vector<FittedModel>& fits) {
      if (auto written = report->draw(index, shown, fits); !written) {
        const std::lock_guard lock(mutex);
        drawn = std::move(written);
      }
    };
  const auto library = library_with(arguments.primitives, arguments.upsampling);
  if (!library) return tl::unexpected(library.error());
  auto cases = run_evaluation(specs, *library, arguments.evaluation, observer);
  if (!cases) return tl::unexpected(cases.error());
  if (!drawn) return tl::unexpected(drawn.error());
  return EvaluationRecord{machine_name(), source_commit(), arguments.cases.seed, arguments.evaluation.methods, describe(arguments), std::move(*cases)};
}

Result<void> run_eval(EvalArguments arguments) {
  if (arguments.folders.empty()) arguments.families = true;
  arguments.cases.noise_scale = arguments.noise == "none" ? 0.0 : 1.0;
  arguments.evaluation.class_known = !arguments.class_estimated;
  arguments.evaluation.mask_from_truth = arguments.mask == "truth";
  std::optional<EvaluationReport> report;
  if (!arguments.report.empty()) {
    auto created = EvaluationReport::create(arguments.report);
    if (!created) return tl::unexpected(created.error());
    report = std::move(*created);
  }
  const auto specs = list_cases(arguments);
  if (!specs) return tl::unexpected(specs.error());
  const auto record = evaluate(arguments, *specs, report ? &*report : nullptr);
  if (!record) return tl::unexpected(record.error());
  std::cout << (arguments.json ? to_json(*record) + "\n" : describe(arguments) + "\n" + to_text(*record));
  if (report)
    if (auto written = report->finish(*record); !written) return written;
  return {};
}

}  // namespace

void add_eval_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<EvalArguments>();
  EvalArguments& a = *arguments;
  CLI::App* eval = app.add_subcommand("eval", "Measure the methods on known objects: true volume, surface, hidden side, grasps, time");
  eval->add_option("DIR", a.folders, "Folders with a meshes.csv (virtual camera) or a poses.json (posed real frames)");
  eval->add_flag("--families", a.families, "Held-out members of the parametric families (what is evaluated where no DIR is given)");
  eval->add_option("--methods", a.evaluation.methods, "Methods by name, side by side on the same views")->delimiter(',')->capture_default_str();
  eval->add_option("--primitives", a.primitives, kPrimitivesHelp);
  eval->add_option("--upsampling", a.upsampling, kUpsamplingHelp)->check(CLI::Range(0, kMaxUpsampling))->capture_default_str();
  auto* known = eval->add_flag("--class-known", a.class_known, "Tell the methods the class (default)");
  eval->add_flag("--class-estimated", a.class_estimated, "Let the pipeline find the class")->excludes(known);
  eval->add_option("--views", a.cases.views, "Yaws per object and elevation")->check(CLI::Range(1, 360))->capture_default_str();
  eval->add_option("--elevation", a.cases.elevations_deg, "Camera elevations above the table, degrees")->delimiter(',')->check(CLI::Range(5.0, 85.0))->capture_default_str();
  eval->add_option("--cameras", a.cases.cameras, "Standpoints, evenly around the object, whose views gfp_robust fits together; of posed frames so many")->check(CLI::Range(1, 8))->capture_default_str();
  eval->add_option("--occlusion", a.cases.occlusion, "Share of the object's pixels that a nearer box hides")->check(CLI::Range(0.0, 0.9))->capture_default_str();
  eval->add_option("--noise", a.noise, "The virtual camera's errors")->check(CLI::IsMember({"kinect", "none"}))->capture_default_str();
  eval->add_option("--mask", a.mask, "The object's pixels: found by the pipeline's segmentation, or given")->check(CLI::IsMember({"segmented", "truth"}))->capture_default_str();
  eval->add_option("--instances", a.cases.instances, "Members per family")->check(CLI::Range(1, 1000))->capture_default_str();
  eval->add_option("--free-form", a.cases.free_form, "Smooth random displacement of family members, share of their size")->check(CLI::Range(0.0, 0.2))->capture_default_str();
  eval->add_option("--only", a.cases.only, "Only objects whose class or name holds this text");
  eval->add_flag("--grasps", a.evaluation.grasps, "Plan grasps on the fit and judge them on the true object");
  eval->add_option("--seed", a.cases.seed, "Of noise, yaws and family members")->capture_default_str();
  eval->add_option("--jobs", a.evaluation.jobs, "Cases at a time; 0: as many as there are cores")->check(CLI::Range(0, 1024))->capture_default_str();
  eval->add_option("--report", a.report, "Folder for a page of pictures, JSON and CSV");
  eval->add_flag("--json", a.json, "JSON on standard output instead of a table");
  eval->callback([arguments, &status] {
    if (const auto done = run_eval(*arguments); !done) status.fail(std::cerr, "eval", done.error());
  });
}

}  // namespace gfp
