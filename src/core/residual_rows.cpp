#include "gfp/core/residual_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace gfp {
namespace {

constexpr std::size_t kBlock = 4;
using Four = double __attribute__((vector_size(kBlock * sizeof(double))));

/// block (4 x 4) = sum over rows of weight * row[i0 + a] * row[j0 + b].
__attribute__((target_clones("arch=x86-64-v3", "default"))) void sum_block(const double* rows, const double* weights, std::size_t count, std::size_t stride,
                                                                           std::size_t i0, std::size_t j0, double* block) {
  Four sum[kBlock] = {};
  for (std::size_t k = 0; k < count; ++k) {
    const double* row = rows + k * stride;
    Four right;
    std::memcpy(&right, row + j0, sizeof right);
    for (std::size_t a = 0; a < kBlock; ++a) sum[a] += weights[k] * row[i0 + a] * right;
  }
  std::memcpy(block, sum, sizeof sum);
}

}  // namespace

void ResidualRows::reset(int unknowns) {
  unknowns_ = static_cast<std::size_t>(unknowns);
  stride_ = (unknowns_ + 1 + kBlock - 1) / kBlock * kBlock;
  rows_.clear();
}

std::span<double> ResidualRows::add(double residual) {
  const std::size_t begin = rows_.size();
  rows_.resize(begin + stride_, 0.0);
  rows_[begin + unknowns_] = residual;
  return {rows_.data() + begin, unknowns_};
}

void ResidualRows::normal_equations(std::span<const double> weights, Eigen::MatrixXd& information, Eigen::VectorXd& gradient) const {
  const auto index = [](std::size_t k) { return static_cast<Eigen::Index>(k); };
  information.resize(index(unknowns_), index(unknowns_));
  gradient.resize(index(unknowns_));
  for (std::size_t i0 = 0; i0 <= unknowns_; i0 += kBlock) {
    for (std::size_t j0 = 0; j0 <= i0; j0 += kBlock) {
      double block[kBlock * kBlock];
      sum_block(rows_.data(), weights.data(), size(), stride_, i0, j0, block);
      for (std::size_t i = i0; i < std::min(i0 + kBlock, unknowns_ + 1); ++i) {
        for (std::size_t j = j0; j < std::min({j0 + kBlock, i + 1, unknowns_}); ++j) {
          const double sum = block[(i - i0) * kBlock + (j - j0)];
          if (i == unknowns_) gradient[index(j)] = sum;
          else information(index(i), index(j)) = information(index(j), index(i)) = sum;
        }
      }
    }
  }
}

}  // namespace gfp
