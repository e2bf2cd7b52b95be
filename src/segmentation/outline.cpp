#include "segmentation/outline.hpp"

#include <algorithm>
#include <cmath>

#include "segmentation/components.hpp"

namespace gfp {
namespace {

constexpr int kSearchPx = 24;       // an occluder's shadow without readings is this wide at most
constexpr float kNearer = 0.015F;   // share of the depth by which an occluder is nearer

// Whether, from an outline pixel, the first reading in this direction is another segment that is nearer.
bool nearer_segment(const OrganizedCloud& cloud, const Image<std::int32_t>& labels, std::int32_t own, int u, int v, int du, int dv) {
  const float z = cloud.z[labels.index(u, v)];
  for (int step = 1; step <= kSearchPx; ++step) {
    u += du;
    v += dv;
    if (!labels.contains(u, v)) return false;
    const auto i = labels.index(u, v);
    if (labels.pixels[i] == own) return false;
    if (!cloud.valid(i)) continue;
    return labels.pixels[i] >= 0 && cloud.z[i] < z * (1.0F - kNearer);
  }
  return false;
}

}  // namespace

PixelRect readings_rect(const OrganizedCloud& cloud, const std::vector<std::uint8_t>& valid) {
  PixelRect rect{cloud.width, cloud.height, 0, 0};
  for (int v = 0; v < cloud.height; ++v) {
    const auto* row = valid.data() + static_cast<std::ptrdiff_t>(v) * cloud.width;
    const auto* end = row + cloud.width;
    const auto* first = std::find_if(row, end, [](auto flag) { return flag != 0; });
    if (first == end) continue;
    const auto* last = end;
    while (*(last - 1) == 0) --last;
    rect = {std::min(rect.u0, static_cast<int>(first - row)), std::min(rect.v0, v), std::max(rect.u1, static_cast<int>(last - row)), v + 1};
  }
  return rect;
}

void describe_outline(const OrganizedCloud& cloud, const Image<std::int32_t>& labels, const PixelRect& readings,
                      const FlatSurface* support, Segment& segment) {
  const int width = cloud.width;
  segment.bbox = bounding_box(segment.pixels, width);
  const std::int32_t own = labels.pixels[static_cast<std::size_t>(segment.pixels.front())];
  const auto height = [&](std::int32_t i) { return support != nullptr ? static_cast<float>(support->height(cloud, i)) : -cloud.y[static_cast<std::size_t>(i)]; };
  std::vector<float> sorted;
  const std::size_t every = segment.pixels.size() / 4000 + 1;  // plenty for the quantiles
  for (std::size_t k = 0; k < segment.pixels.size(); k += every) sorted.push_back(height(segment.pixels[k]));
  const auto quantile = [&](double share) {
    const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), nth, sorted.end());
    return *nth;
  };
  const float top = quantile(0.995), near_top = quantile(0.97), bottom = quantile(0.005);
  segment.height_m = support != nullptr ? top : top - bottom;

  int cut = 0, top_pixels = 0, top_cut = 0, hidden = 0;
  int v = segment.bbox.v0;
  for (const auto i : segment.pixels) {
    while (i >= (v + 1) * width) ++v;
    const int u = i - v * width;
    const bool border = at_border(readings, u, v);
    const std::int32_t* label = &labels.pixels[static_cast<std::size_t>(i)];
    if (!border && label[1] == own && label[-1] == own && label[width] == own && label[-width] == own) continue;
    bool is_hidden = false, on_outline = false;
    constexpr int kSteps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto& step : kSteps) {
      if (!labels.contains(u + step[0], v + step[1]) || labels.pixels[static_cast<std::size_t>(i + step[1] * width + step[0])] == own) continue;
      on_outline = true;
      is_hidden = is_hidden || nearer_segment(cloud, labels, own, u, v, step[0], step[1]);
    }
    cut += border;
    hidden += is_hidden;
    if ((border || on_outline) && height(i) >= near_top) {
      ++top_pixels;
      top_cut += border || is_hidden;
    }
  }
  segment.touches_border = cut >= 3;
  segment.occluded = hidden >= 5;
  segment.top_cut = top_pixels > 0 && 10 * top_cut >= top_pixels;
}

}  // namespace gfp
