#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/evaluation/cases.hpp"
#include "gfp/primitive/primitive_library.hpp"

namespace gfp {

/// What one way of fitting did over an experiment's views: medians. Empty where it has no such figure.
struct ExperimentRow {
  std::string name;
  int views = 0;
  std::optional<double> points, moved_controls, moved_regulars, iterations;
  double cpu_ms = 0;              ///< Of what the experiment times, in its thread.
  double fit_similarity = 0;      ///< P28, gamma = 1/(5 mm)^2: 1 is a perfect fit.
  double iou_filled = 0, volume_error = 0;
  double self_crossing_share = 0;
  std::string paper;              ///< What the paper printed for it.
};

/// Energies of one contour, one an iteration, from its start; the first view's.
struct EnergyCurve {
  std::string name;
  std::vector<double> energies;
};

struct Experiment {
  std::string name, question;     ///< What the paper claims, in a sentence.
  std::string views;              ///< Which objects were looked at.
  std::string timed;              ///< What cpu_ms is the time of.
  std::vector<ExperimentRow> rows;
  std::vector<EnergyCurve> curves;
};

/// mug (P29), shoe (Table 1, P30), energy (Fig. 6, P29), speed.
std::vector<std::string> experiment_names();

/// Reproduces one of the paper's experiments, each way of fitting on the same views; the class is told, the object's pixels are found.
///
/// @param folder  known objects as list_folder_cases() reads them; empty: held-out members of the families. Objects of the experiment's
///                class alone are used (of every class for `speed`). @param options  of the cases; `only` is set by the experiment.
/// One thread, so that times are comparable. Same results for the same seed, but for the times.
/// Errors: kNotFound (no such experiment, naming the known; no object of the class), those of the cases.
Result<Experiment> run_experiment(std::string_view name, const PrimitiveLibrary& library, const std::filesystem::path& folder = {}, CaseOptions options = {},
                                  const std::function<void(std::size_t done, std::size_t total)>& progress = {});

std::string to_text(const Experiment& experiment);
/// {experiment, machine, commit, seed, views, timed, rows[], curves[]}.
std::string to_json(const Experiment& experiment, std::uint64_t seed);
/// DIR/index.html with the table and the curves, experiment.json, and curves.csv where there are curves. Errors: kIo.
Result<void> write_experiment(const Experiment& experiment, std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace gfp
