#include "cloud/remove_small_regions.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "gfp/core/union_find.hpp"

namespace gfp {
namespace {

/// Pixels [begin, end) of one row that belong together.
struct Run {
  int begin, end;
};

class Regions {
 public:
  Regions(Image<std::uint16_t>& image, int max_step) : image_(image), max_step_(max_step) {
    for (int v = 0; v < image.height; ++v) {
      first_of_row_.push_back(runs_.size());
      add_runs(row(v));
      if (v > 0) join_with_row_above(v);
    }
    first_of_row_.push_back(runs_.size());
  }

  void remove_below(int min_pixels) {
    std::vector<int> pixels(runs_.size(), 0);
    for (std::size_t r = 0; r < runs_.size(); ++r) pixels[region(r)] += runs_[r].end - runs_[r].begin;
    for (int v = 0; v < image_.height; ++v)
      for (std::size_t r = first_of_row_[static_cast<std::size_t>(v)]; r < first_of_row_[static_cast<std::size_t>(v) + 1]; ++r)
        if (pixels[region(r)] < min_pixels) std::fill(row(v) + runs_[r].begin, row(v) + runs_[r].end, std::uint16_t{0});
  }

 private:
  std::uint16_t* row(int v) { return &image_.pixels[image_.index(0, v)]; }
  std::size_t region(std::size_t run) { return static_cast<std::size_t>(sets_.root(static_cast<std::int32_t>(run))); }

  void add_runs(const std::uint16_t* pixels) {
    for (int u = 0; u < image_.width;) {
      if (pixels[u] == 0) {
        ++u;
        continue;
      }
      const int begin = u++;
      while (u < image_.width && pixels[u] != 0 && std::abs(pixels[u] - pixels[u - 1]) <= max_step_) ++u;
      runs_.push_back({begin, u});
      sets_.add();
    }
  }

  /// Joins the last row's runs with those above that they touch somewhere within max_step.
  void join_with_row_above(int v) {
    const std::uint16_t *const pixels = row(v), *const above = row(v - 1);
    std::size_t a = first_of_row_[static_cast<std::size_t>(v) - 1], b = first_of_row_.back();
    const std::size_t first = b;
    while (a < first && b < runs_.size()) {
      const int from = std::max(runs_[a].begin, runs_[b].begin), to = std::min(runs_[a].end, runs_[b].end);
      for (int u = from; u < to; ++u) {
        if (std::abs(above[u] - pixels[u]) > max_step_) continue;
        sets_.join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
        break;
      }
      ++(runs_[a].end < runs_[b].end ? a : b);
    }
  }

  Image<std::uint16_t>& image_;
  int max_step_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_of_row_;
  UnionFind sets_;
};

}  // namespace

void remove_small_regions(Image<std::uint16_t>& image, int max_step, int min_pixels) { Regions(image, max_step).remove_below(min_pixels); }

}  // namespace gfp
