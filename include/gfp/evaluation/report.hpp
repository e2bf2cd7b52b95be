#pragma once

#include <filesystem>

#include "gfp/evaluation/summary.hpp"

namespace gfp {

/// The page of pictures of a run: DIR/index.html with a table and a row of pictures per case, DIR/cases/*.png, and the numbers
/// as cases.json and cases.csv.
class EvaluationReport {
 public:
  /// Makes the folders. Errors: kIo.
  static Result<EvaluationReport> create(const std::filesystem::path& folder);

  /// Draws one case; safe from several threads at once. Errors: kIo.
  Result<void> draw(std::size_t index, const EvaluationCase& shown, const std::vector<FittedModel>& fits) const;

  /// Writes page and numbers, once all cases are drawn. Errors: kIo.
  Result<void> finish(const EvaluationRecord& record) const;

 private:
  explicit EvaluationReport(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path folder_;
};

}  // namespace gfp
