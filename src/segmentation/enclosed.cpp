#include "segmentation/enclosed.hpp"

#include <algorithm>

namespace gfp {
namespace {

constexpr std::size_t kMinPixels = 30;
constexpr double kMinMeanHeight = 0.002;  // metres: the mean over many pixels of a support's noise is well below
constexpr double kMinRise = 0.0015;       // metres above what is around the object: a table is not warped like that over an object's width

// The object's bounding box: pixels on a support that are still unvisited are 1.
struct Box {
  int u0, v0, width, height;
  std::vector<std::uint8_t> open;
};

Box open_pixels(const OrganizedCloud& cloud, const std::vector<std::uint8_t>& classes, const PixelList& pixels) {
  const PixelRect rect = bounding_box(pixels, cloud.width);
  Box box{rect.u0, rect.v0, rect.width(), rect.height(), {}};
  box.open.reserve(static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height));
  for (int v = rect.v0; v < rect.v1; ++v)
    for (int u = rect.u0; u < rect.u1; ++u) {
      const auto c = classes[static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width) + static_cast<std::size_t>(u)];
      box.open.push_back(c >= kOnSupport && c < kAbove);
    }
  return box;
}

// Closes and returns the 4-connected open pixels around `seed`.
std::vector<int> flood(Box& box, int seed) {
  std::vector<int> region{seed};
  box.open[static_cast<std::size_t>(seed)] = 0;
  for (std::size_t next = 0; next < region.size(); ++next) {
    const int i = region[next], u = i % box.width, v = i / box.width;
    const auto visit = [&](int n) {
      if (box.open[static_cast<std::size_t>(n)] == 0) return;
      box.open[static_cast<std::size_t>(n)] = 0;
      region.push_back(n);
    };
    if (u > 0) visit(i - 1);
    if (u + 1 < box.width) visit(i + 1);
    if (v > 0) visit(i - box.width);
    if (v + 1 < box.height) visit(i + box.width);
  }
  return region;
}

/// Mean heights over a region: above the support as it is warped, and above its plain plane.
struct Heights {
  double warped = 0, plain = 0;
  std::size_t pixels = 0;

  void add(const OrganizedCloud& cloud, const FlatSurface& support, std::int32_t pixel) {
    warped += support.height(cloud, pixel);
    plain += support.plane_height(cloud, pixel);
    ++pixels;
  }
  double mean_warped() const { return warped / static_cast<double>(std::max<std::size_t>(1, pixels)); }
  double mean_plain() const { return plain / static_cast<double>(std::max<std::size_t>(1, pixels)); }
};

}  // namespace

void take_enclosed(const OrganizedCloud& cloud, const std::vector<std::uint8_t>& classes, const FlatSurface& support, PixelList& pixels) {
  Box box = open_pixels(cloud, classes, pixels);
  const auto in_image = [&](int i) { return (box.v0 + i / box.width) * cloud.width + box.u0 + i % box.width; };
  std::vector<std::vector<int>> outer, enclosed;
  const auto flood_from = [&](int seed, auto& regions) {
    if (box.open[static_cast<std::size_t>(seed)] != 0) regions.push_back(flood(box, seed));
  };
  const int last_row = (box.height - 1) * box.width;
  for (int u = 0; u < box.width; ++u)
    for (const int border : {u, last_row + u}) flood_from(border, outer);
  for (int v = 0; v < box.height; ++v)
    for (const int border : {v * box.width, v * box.width + box.width - 1}) flood_from(border, outer);
  for (int i = 0; i < static_cast<int>(box.open.size()); ++i) flood_from(i, enclosed);
  std::erase_if(enclosed, [](const auto& region) { return region.size() < kMinPixels; });
  if (enclosed.empty()) return;

  const auto add_all = [&](const std::vector<int>& region, Heights& heights) {
    for (const int i : region) heights.add(cloud, support, in_image(i));
  };
  Heights around;
  for (const auto& region : outer) add_all(region, around);
  const std::size_t before = pixels.size();
  for (const auto& region : enclosed) {
    Heights heights;
    add_all(region, heights);
    // The flat middle of a plate may have been taken for a warp of the table.
    const bool rises = around.pixels >= kMinPixels && heights.mean_plain() - around.mean_plain() > kMinRise;
    if (!rises && !(heights.mean_warped() > kMinMeanHeight)) continue;
    for (const int i : region) pixels.push_back(in_image(i));
  }
  if (pixels.size() != before) std::sort(pixels.begin(), pixels.end());
}

}  // namespace gfp
