#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// Appends one triangle as up to four, by the middles (a vertex, or -1: not split) of its edges (0, 1), (1, 2), (2, 0).
inline void split_triangle(Triangle t, std::array<std::int32_t, 3> middle, std::vector<Triangle>& out) {
  const auto split = std::count_if(middle.begin(), middle.end(), [](std::int32_t m) { return m >= 0; });
  if (split == 0) return out.push_back(t);
  if (split == 3) {
    out.insert(out.end(), {{t[0], middle[0], middle[2]}, {middle[0], t[1], middle[1]}, {middle[2], middle[1], t[2]}, {middle[0], middle[1], middle[2]}});
    return;
  }
  // Turned so that the first edge is split, and with two of them the third is not.
  while (middle[0] < 0 || (split == 2 && middle[2] >= 0)) {
    std::rotate(t.begin(), t.begin() + 1, t.end());
    std::rotate(middle.begin(), middle.begin() + 1, middle.end());
  }
  if (split == 1) out.insert(out.end(), {{t[0], middle[0], t[2]}, {middle[0], t[1], t[2]}});
  else out.insert(out.end(), {{middle[0], t[1], middle[1]}, {t[0], middle[0], middle[1]}, {t[0], middle[1], t[2]}});
}

}  // namespace gfp
