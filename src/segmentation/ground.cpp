#include "segmentation/ground.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

// Height of the cell's middle above the plane c . p = 1: (1/z - c . ray) / (|c| / z).
float cell_offset(const Cell& cell, const PlaneFit& plane) {
  return static_cast<float>(cell.offset_from(plane) / (cell.mean_inverse() * plane.coefficients.norm()));
}

// Unknown cells take the mean of their known neighbours, ring after ring from the known ones outwards.
void fill(Ground& ground, std::vector<std::uint8_t> known) {
  std::vector<int> frontier;
  const auto each_neighbour = [&](int cell, auto&& visit) {
    const int c = cell % ground.columns, r = cell / ground.columns;
    for (int nr = std::max(0, r - 1); nr <= std::min(ground.rows - 1, r + 1); ++nr)
      for (int nc = std::max(0, c - 1); nc <= std::min(ground.columns - 1, c + 1); ++nc)
        if (nr != r || nc != c) visit(nr * ground.columns + nc);
  };
  std::vector<std::uint8_t> queued = known;
  const auto queue_around = [&](int cell, std::vector<int>& queue) {
    each_neighbour(cell, [&](int n) {
      if (queued[static_cast<std::size_t>(n)] != 0) return;
      queued[static_cast<std::size_t>(n)] = 1;
      queue.push_back(n);
    });
  };
  for (int cell = 0; cell < static_cast<int>(known.size()); ++cell)
    if (known[static_cast<std::size_t>(cell)] != 0) queue_around(cell, frontier);
  while (!frontier.empty()) {
    std::vector<float> values;
    for (const int cell : frontier) {
      float sum = 0, count = 0;
      each_neighbour(cell, [&](int n) {
        if (known[static_cast<std::size_t>(n)] == 0) return;
        sum += ground.offset_m[static_cast<std::size_t>(n)];
        count += 1;
      });
      values.push_back(sum / count);
    }
    std::vector<int> next;
    for (std::size_t k = 0; k < frontier.size(); ++k) {
      ground.offset_m[static_cast<std::size_t>(frontier[k])] = values[k];
      known[static_cast<std::size_t>(frontier[k])] = 1;
    }
    for (const int cell : frontier) queue_around(cell, next);
    frontier = std::move(next);
  }
}

}  // namespace

float Ground::at(int u, int v) const {
  const float per_pixel = 1.0F / static_cast<float>(cell_px);
  const auto cell = [&](int pixel, int cells) { return std::clamp((static_cast<float>(pixel) + 0.5F) * per_pixel - 0.5F, 0.0F, static_cast<float>(cells - 1)); };
  const float x = cell(u, columns), y = cell(v, rows);
  const int c0 = static_cast<int>(x), r0 = static_cast<int>(y), c1 = std::min(c0 + 1, columns - 1), r1 = std::min(r0 + 1, rows - 1);
  const auto value = [&](int c, int r) { return offset_m[static_cast<std::size_t>(r * columns + c)]; };
  const float upper = value(c0, r0) + (x - static_cast<float>(c0)) * (value(c1, r0) - value(c0, r0));
  const float lower = value(c0, r1) + (x - static_cast<float>(c0)) * (value(c1, r1) - value(c0, r1));
  return upper + (y - static_cast<float>(r0)) * (lower - upper);
}

void Ground::interpolate_row(int v, int width, float* row) const {
  const float y = std::clamp((static_cast<float>(v) + 0.5F) / static_cast<float>(cell_px) - 0.5F, 0.0F, static_cast<float>(rows - 1));
  const int r0 = static_cast<int>(y), r1 = std::min(r0 + 1, rows - 1);
  const float down = y - static_cast<float>(r0);
  const auto at = [&](int c) {
    const float upper = offset_m[static_cast<std::size_t>(r0 * columns + c)], lower = offset_m[static_cast<std::size_t>(r1 * columns + c)];
    return upper + down * (lower - upper);
  };
  // Half a cell at either end is constant; between two cell centres the value is linear.
  float left = at(0);
  int u = 0;
  for (; u < std::min(width, cell_px / 2); ++u) row[u] = left;
  for (int c = 0; c + 1 < columns; ++c) {
    const float right = at(c + 1), slope = (right - left) / static_cast<float>(cell_px);
    const int end = std::min(width, u + cell_px);
    for (const int begin = u; u < end; ++u) row[u] = left + (static_cast<float>(u - begin) + 0.5F) * slope;
    left = right;
  }
  for (; u < width; ++u) row[u] = left;
}

Ground ground_of(const CellGrid& grid, const FlatRegion& surface, int cell_px) {
  Ground ground{cell_px, grid.columns, grid.rows, std::vector<float>(grid.cells.size(), 0.0F)};
  std::vector<std::uint8_t> known(grid.cells.size(), 0);
  for (const int c : surface.cells) known[static_cast<std::size_t>(c)] = 1;
  std::vector<float> raw(grid.cells.size(), 0.0F);
  for (const int c : surface.cells) raw[static_cast<std::size_t>(c)] = cell_offset(grid[c], surface.fit);
  for (const int c : surface.cells) {  // the mean with the neighbours: a single cell is noisy and may hold part of an object
    float sum = raw[static_cast<std::size_t>(c)], count = 1;
    grid.neighbours(c, [&](int n) {
      if (known[static_cast<std::size_t>(n)] == 0) return;
      sum += raw[static_cast<std::size_t>(n)];
      count += 1;
    });
    ground.offset_m[static_cast<std::size_t>(c)] = sum / count;
  }
  fill(ground, std::move(known));
  return ground;
}

}  // namespace gfp
