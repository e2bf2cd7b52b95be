#include "segmentation/components.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "gfp/core/union_find.hpp"

namespace gfp {
namespace {

struct Run {
  std::int32_t begin, end;  // pixel indices of one row, half open
};

class Joiner {
 public:
  Joiner(const DepthGrid& depth, const std::vector<std::uint8_t>& classes, const std::vector<std::uint8_t>& valid, const ComponentOptions& options)
      : z_(depth.z), classes_(classes.data()), valid_(valid.data()), width_(depth.width), height_(depth.height),
        tolerance_(static_cast<float>(options.tolerance_m)), gap_(static_cast<float>(options.bridged_gap_m * depth.focal_px)),
        run_of_(std::make_unique_for_overwrite<std::int32_t[]>(classes.size())) {}

  std::vector<PixelList> run(int min_pixels) {
    find_runs();
    for (std::int32_t r = 0; r < static_cast<std::int32_t>(runs_.size()); ++r) {
      cross_gap_rightwards(r);
      join_below(r);
    }
    return collect(min_pixels);
  }

 private:
  bool joined(std::int32_t a, std::int32_t b) const {
    const float za = z_[a], zb = z_[b];
    return classes_[a] == classes_[b] && std::abs(za - zb) <= tolerance_ * std::max(1.0F, za * zb);
  }
  std::int32_t gap_px(std::int32_t a) const { return static_cast<std::int32_t>(std::min(gap_ / z_[a], 64.0F)); }

  /// The first pixel of [i, end) that has a class, or `end`: eight at a time over the usual emptiness.
  std::int32_t next_in_class(std::int32_t i, std::int32_t end) const {
    for (std::uint64_t eight = 0; i + 8 <= end; i += 8) {
      std::memcpy(&eight, classes_ + i, sizeof eight);
      if (eight != 0) break;
    }
    while (i < end && classes_[i] == 0) ++i;
    return i;
  }

  void find_runs() {
    for (std::int32_t v = 0; v < height_; ++v) {
      const std::int32_t row = v * width_, row_end = row + width_;
      for (std::int32_t i = row; i < row_end;) {
        if (classes_[i] == 0) {
          i = next_in_class(i + 1, row_end);
          continue;
        }
        const std::int32_t begin = i;
        const std::int32_t id = sets_.add();
        do { run_of_[static_cast<std::size_t>(i)] = id; ++i; } while (i < row_end && classes_[i] != 0 && joined(i - 1, i));
        runs_.push_back({begin, i});
      }
    }
  }

  void cross_gap_rightwards(std::int32_t r) {
    const std::int32_t last = runs_[static_cast<std::size_t>(r)].end - 1;
    const std::int32_t row_end = (last / width_ + 1) * width_, limit = std::min(row_end, last + 2 + gap_px(last));
    std::int32_t i = last + 1;
    while (i < limit && valid_[i] == 0) ++i;
    if (i < limit && classes_[i] != 0 && joined(last, i)) sets_.join(r, run_of_[static_cast<std::size_t>(i)]);
  }

  void join_below(std::int32_t r) {
    const auto [begin, end] = runs_[static_cast<std::size_t>(r)];
    const std::int32_t pixels = width_ * height_;
    std::int32_t joined_run = -1;  // skips the other columns over the same run
    for (std::int32_t a = begin; a < end; ++a) {
      std::int32_t b = a + width_;
      if (b >= pixels) return;
      if (valid_[b] == 0) {
        const std::int32_t limit = std::min(pixels, b + width_ * gap_px(a));
        do b += width_; while (b < limit && valid_[b] == 0);
        if (b >= limit) continue;
      }
      if (classes_[b] == 0) continue;
      const std::int32_t below = run_of_[static_cast<std::size_t>(b)];
      if (below == joined_run || !joined(a, b)) continue;
      sets_.join(r, below);
      joined_run = below;
    }
  }

  std::vector<PixelList> collect(int min_pixels) {
    std::vector<std::int32_t> sizes(runs_.size(), 0), slot(runs_.size(), -1);
    for (std::int32_t r = 0; r < static_cast<std::int32_t>(runs_.size()); ++r)
      sizes[static_cast<std::size_t>(sets_.root(r))] += runs_[static_cast<std::size_t>(r)].end - runs_[static_cast<std::size_t>(r)].begin;
    std::vector<PixelList> components;
    for (std::int32_t r = 0; r < static_cast<std::int32_t>(runs_.size()); ++r) {
      const auto root = static_cast<std::size_t>(sets_.root(r));
      if (sizes[root] < min_pixels) continue;
      if (slot[root] < 0) {
        slot[root] = static_cast<std::int32_t>(components.size());
        components.emplace_back().reserve(static_cast<std::size_t>(sizes[root]));
      }
      auto& pixels = components[static_cast<std::size_t>(slot[root])];
      for (std::int32_t i = runs_[static_cast<std::size_t>(r)].begin; i < runs_[static_cast<std::size_t>(r)].end; ++i) pixels.push_back(i);
    }
    return components;
  }

  const float* z_;
  const std::uint8_t *classes_, *valid_;
  std::int32_t width_, height_;
  float tolerance_, gap_;
  std::unique_ptr<std::int32_t[]> run_of_;  ///< Of the pixels that have a class.
  std::vector<Run> runs_;
  UnionFind sets_;
};

}  // namespace

PixelRect bounding_box(const PixelList& pixels, int width) {
  PixelRect box{width, pixels.front() / width, 0, pixels.back() / width + 1};
  std::int32_t row = box.v0 * width;  // walked along, for divisions are dear
  for (const std::int32_t i : pixels) {
    while (i >= row + width) row += width;
    box.u0 = std::min(box.u0, i - row);
    box.u1 = std::max(box.u1, i - row + 1);
  }
  return box;
}

std::vector<PixelList> connected_components(const DepthGrid& depth, const std::vector<std::uint8_t>& classes,
                                            const std::vector<std::uint8_t>& valid, const ComponentOptions& options, int min_pixels) {
  return Joiner(depth, classes, valid, options).run(min_pixels);
}

}  // namespace gfp
