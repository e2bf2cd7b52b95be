#include "cloud/remove_small_regions.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

namespace gfp {
namespace {

/// Pixels [begin, end) of one row that belong together. `parent` makes a forest of runs; a root's `pixels` are the region's.
struct Run {
  int begin, end;
  std::size_t parent;
  int pixels;
};

std::size_t root_of(std::vector<Run>& runs, std::size_t run) {
  while (runs[run].parent != run) run = runs[run].parent = runs[runs[run].parent].parent;
  return run;
}

void join(std::vector<Run>& runs, std::size_t a, std::size_t b) {
  a = root_of(runs, a), b = root_of(runs, b);
  if (a == b) return;
  if (b < a) std::swap(a, b);
  runs[b].parent = a;
  runs[a].pixels += runs[b].pixels;
}

void add_runs(const std::uint16_t* row, int width, int max_step, std::vector<Run>& runs) {
  for (int u = 0; u < width;) {
    if (row[u] == 0) {
      ++u;
      continue;
    }
    const int begin = u++;
    while (u < width && row[u] != 0 && std::abs(row[u] - row[u - 1]) <= max_step) ++u;
    runs.push_back({begin, u, runs.size(), u - begin});
  }
}

/// Runs [above, here) lie in the row over runs [here, end): joins those that touch somewhere within max_step.
void join_rows(const std::uint16_t* row_above, const std::uint16_t* row, int max_step, std::size_t above, std::size_t here, std::vector<Run>& runs) {
  const std::size_t first = here, end = runs.size();
  while (above < first && here < end) {
    const int from = std::max(runs[above].begin, runs[here].begin), to = std::min(runs[above].end, runs[here].end);
    for (int u = from; u < to; ++u) {
      if (std::abs(row_above[u] - row[u]) > max_step) continue;
      join(runs, above, here);
      break;
    }
    ++(runs[above].end < runs[here].end ? above : here);
  }
}

}  // namespace

void remove_small_regions(Image<std::uint16_t>& image, int max_step, int min_pixels) {
  std::vector<Run> runs;
  std::vector<std::size_t> first_of_row{0};
  for (int v = 0; v < image.height; ++v) {
    const std::uint16_t* const row = &image.pixels[image.index(0, v)];
    add_runs(row, image.width, max_step, runs);
    if (v > 0) join_rows(row - image.width, row, max_step, first_of_row[static_cast<std::size_t>(v) - 1], first_of_row.back(), runs);
    first_of_row.push_back(runs.size());
  }
  for (int v = 0; v < image.height; ++v) {
    std::uint16_t* const row = &image.pixels[image.index(0, v)];
    for (std::size_t r = first_of_row[static_cast<std::size_t>(v)]; r < first_of_row[static_cast<std::size_t>(v) + 1]; ++r)
      if (runs[root_of(runs, r)].pixels < min_pixels) std::fill(row + runs[r].begin, row + runs[r].end, std::uint16_t{0});
  }
}

}  // namespace gfp
