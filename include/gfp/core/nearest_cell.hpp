#pragma once

namespace gfp {

/// The cell of a row-major grid that is nearest to `cell`, itself included, among those that `accept`; -1 where there is none within
/// `reach` cells. Looks in growing squares, so that what is near is found at once.
template <class Accept>
int nearest_cell(int width, int height, int cell, int reach, Accept&& accept) {
  if (accept(cell)) return cell;
  const int u = cell % width, v = cell / width;
  int best = -1, best_squared = reach * reach + 1;
  const auto look = [&](int i, int j) {
    if (i < 0 || j < 0 || i >= width || j >= height) return;
    const int squared = (i - u) * (i - u) + (j - v) * (j - v), there = j * width + i;
    if (squared >= best_squared || !accept(there)) return;
    best = there;
    best_squared = squared;
  };
  for (int ring = 1; ring <= reach && ring * ring < best_squared; ++ring) {
    for (int k = -ring; k <= ring; ++k) {
      look(u + k, v - ring);
      look(u + k, v + ring);
    }
    for (int k = -ring + 1; k < ring; ++k) {
      look(u - ring, v + k);
      look(u + ring, v + k);
    }
  }
  return best;
}

}  // namespace gfp
