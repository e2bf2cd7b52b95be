#pragma once

#include <vector>

namespace gfp {

/// The partial one-to-one assignment of rows to columns with the greatest sum of affinities.
///
/// @param affinity  rows x columns, row-major; only positive entries are ever assigned.
/// @return per row its column, or -1. Ties: the same input gives the same answer.
/// Shortest augmenting paths with potentials (Jonker & Volgenant, Computing 1987); O(rows^2 (rows + columns)).
std::vector<int> optimal_assignment(const std::vector<double>& affinity, int rows, int columns);

}  // namespace gfp
