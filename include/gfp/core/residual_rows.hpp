#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace gfp {

/// Rows of a weighted linear least-squares problem, gathered first and summed at once: the sums are then small matrix products in
/// registers instead of one outer product in memory per row, several times faster, and still added in the order of the rows.
class ResidualRows {
 public:
  /// Forgets all rows; the following have this many unknowns.
  void reset(int unknowns);

  /// A row of zeros for the caller to fill: the residual's derivative by each unknown. Valid until the next call.
  std::span<double> add(double residual);

  std::size_t size() const { return rows_.size() / stride_; }
  double residual(std::size_t row) const { return rows_[row * stride_ + unknowns_]; }

  /// `information` = sum weight J^T J, symmetric, unknowns x unknowns; `gradient` = sum weight J^T residual. One weight a row.
  void normal_equations(std::span<const double> weights, Eigen::MatrixXd& information, Eigen::VectorXd& gradient) const;

 private:
  std::size_t unknowns_ = 0, stride_ = 1;  ///< A row is its derivatives, then the residual, then zeros up to the stride.
  std::vector<double> rows_;
};

}  // namespace gfp
