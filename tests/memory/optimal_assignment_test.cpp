#include "memory/optimal_assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

double total(const std::vector<double>& affinity, int columns, const std::vector<int>& column_of) {
  double sum = 0;
  for (std::size_t r = 0; r < column_of.size(); ++r)
    if (column_of[r] >= 0) sum += affinity[r * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column_of[r])];
  return sum;
}

/// Tries every partial assignment: the oracle.
double best_total(const std::vector<double>& affinity, int rows, int columns, int row, unsigned used) {
  if (row == rows) return 0;
  double best = best_total(affinity, rows, columns, row + 1, used);
  for (int c = 0; c < columns; ++c) {
    const double a = affinity[static_cast<std::size_t>(row * columns + c)];
    if (a > 0 && !(used >> c & 1U)) best = std::max(best, a + best_total(affinity, rows, columns, row + 1, used | 1U << c));
  }
  return best;
}

// Greedy takes 0.9 and leaves 0 for the other row; the best sum is 0.8 + 0.7.
TEST(OptimalAssignment, IsNotGreedy) {
  EXPECT_EQ(optimal_assignment({0.9, 0.8, 0.7, 0.0}, 2, 2), (std::vector<int>{1, 0}));
}

TEST(OptimalAssignment, LeavesAloneWhatHasNoAffinity) {
  EXPECT_EQ(optimal_assignment({0.0, 0.5, 0.0, 0.0}, 2, 2), (std::vector<int>{1, -1}));
  EXPECT_EQ(optimal_assignment({}, 0, 0), std::vector<int>{});
  EXPECT_EQ(optimal_assignment({}, 2, 0), (std::vector<int>{-1, -1}));
}

TEST(OptimalAssignment, EqualsBruteForceAndUsesEachColumnOnce) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int rows = 1 + random.below(6), columns = 1 + random.below(6);
    std::vector<double> affinity;
    for (int i = 0; i < rows * columns; ++i) affinity.push_back(random.uniform() < 0.4 ? 0.0 : random.uniform());
    const std::vector<int> column_of = optimal_assignment(affinity, rows, columns);
    EXPECT_NEAR(total(affinity, columns, column_of), best_total(affinity, rows, columns, 0, 0), 1e-12);  // rounding of sums
    std::vector<int> used(column_of);
    std::erase(used, -1);
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::adjacent_find(used.begin(), used.end()), used.end());
  }
}

}  // namespace
}  // namespace gfp
