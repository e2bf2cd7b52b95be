#include "memory/optimal_assignment.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>

namespace gfp {
namespace {

/// Minimum-cost assignment of every row to a column of its own, grown row by row; columns >= rows. Rows and columns are
/// counted from 1 and column 0 is the root of each search, as is usual for this formulation.
class AssignmentSearch {
 public:
  AssignmentSearch(int rows, int columns)
      : rows_(rows), columns_(columns), row_potential_(index(rows + 1)), column_potential_(index(columns + 1)),
        row_of_(index(columns + 1)), previous_(index(columns + 1)) {}

  template <class Cost>
  void add_row(int row, const Cost& cost) {
    row_of_[0] = row;
    std::vector<double> distance(index(columns_ + 1), std::numeric_limits<double>::infinity());
    std::vector<bool> settled(index(columns_ + 1), false);
    int column = 0;
    while (row_of_[index(column)] != 0) {
      settled[index(column)] = true;
      column = settle_next(column, cost, distance, settled);
    }
    while (column != 0) {  // flip the path: every column on it takes its predecessor's row
      row_of_[index(column)] = row_of_[index(previous_[index(column)])];
      column = previous_[index(column)];
    }
  }

  int row_of(int column) const { return row_of_[index(column)]; }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  template <class Cost>
  int settle_next(int from, const Cost& cost, std::vector<double>& distance, const std::vector<bool>& settled) {
    const int row = row_of_[index(from)];
    int nearest = -1;
    for (int c = 1; c <= columns_; ++c) {
      if (settled[index(c)]) continue;
      const double reduced = cost(row, c) - row_potential_[index(row)] - column_potential_[index(c)];
      if (reduced < distance[index(c)]) {
        distance[index(c)] = reduced;
        previous_[index(c)] = from;
      }
      if (nearest < 0 || distance[index(c)] < distance[index(nearest)]) nearest = c;
    }
    const double step = distance[index(nearest)];
    for (int c = 0; c <= columns_; ++c) {
      if (settled[index(c)]) {
        row_potential_[index(row_of_[index(c)])] += step;
        column_potential_[index(c)] -= step;
      } else {
        distance[index(c)] -= step;
      }
    }
    return nearest;
  }

  int rows_, columns_;
  std::vector<double> row_potential_, column_potential_;
  std::vector<int> row_of_, previous_;
};

}  // namespace

std::vector<int> optimal_assignment(const std::vector<double>& affinity, int rows, int columns) {
  assert(affinity.size() == static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  // One extra column a row at cost 0 is "none of them".
  const auto cost = [&](int row, int column) {
    if (column > columns) return 0.0;
    const auto at = static_cast<std::size_t>(row - 1) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column - 1);
    return affinity[at] > 0 ? -affinity[at] : 1.0;  // dearer than none
  };
  AssignmentSearch search(rows, columns + rows);
  for (int row = 1; row <= rows; ++row) search.add_row(row, cost);

  std::vector<int> column_of(static_cast<std::size_t>(rows), -1);
  for (int column = 1; column <= columns; ++column)
    if (const int row = search.row_of(column); row != 0) column_of[static_cast<std::size_t>(row - 1)] = column - 1;
  return column_of;
}

}  // namespace gfp
