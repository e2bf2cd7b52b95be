#pragma once

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <vector>

#include "gfp/core/image.hpp"

namespace gfp::test {

/// The disparity with the smallest sum of five paths at every pixel (the lowest of equals), by the textbook and in plain loops.
inline Image<int> match_plainly(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, int disparities, int small_step, int jump) {
  const int width = left.width, height = left.height;
  const auto census = [&](const Image<std::uint8_t>& image, int u, int v) {
    unsigned bits = 0;
    for (int dv = -2; dv <= 2; ++dv)
      for (int du = -2; du <= 2; ++du)
        if (du != 0 || dv != 0) bits = 2 * bits + (image.at(std::clamp(u + du, 0, width - 1), std::clamp(v + dv, 0, height - 1)) < image.at(u, v) ? 1U : 0U);
    return bits;
  };
  const auto at = [&](int u, int v, int d) { return (static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)) * static_cast<std::size_t>(disparities) + static_cast<std::size_t>(d); };
  std::vector<int> cost(at(0, height, 0)), sum(cost.size(), 0);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (int d = 0; d < disparities; ++d) cost[at(u, v, d)] = u < d ? 24 : __builtin_popcount(census(left, u, v) ^ census(right, u - d, v));
  constexpr int kSteps[5][2] = {{-1, 0}, {1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  for (const auto& [du, dv] : kSteps) {
    std::vector<int> path(cost.size());
    for (int v = 0; v < height; ++v)
      for (int i = 0; i < width; ++i) {
        const int u = du > 0 && dv == 0 ? width - 1 - i : i;
        const bool begins = u + du < 0 || u + du >= width || v + dv < 0;
        int least_before = std::numeric_limits<int>::max();
        for (int d = 0; d < disparities && !begins; ++d) least_before = std::min(least_before, path[at(u + du, v + dv, d)]);
        for (int d = 0; d < disparities; ++d) {
          int before = begins ? 0 : least_before + jump;
          for (int e = std::max(0, d - 1); e <= std::min(disparities - 1, d + 1) && !begins; ++e) before = std::min(before, path[at(u + du, v + dv, e)] + (e == d ? 0 : small_step));
          path[at(u, v, d)] = cost[at(u, v, d)] + before - (begins ? 0 : least_before);
          sum[at(u, v, d)] += path[at(u, v, d)];
        }
      }
  }
  Image<int> best(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const auto first = sum.begin() + static_cast<std::ptrdiff_t>(at(u, v, 0));
      best.at(u, v) = static_cast<int>(std::min_element(first, first + disparities) - first);
    }
  return best;
}

}  // namespace gfp::test
