#include "segmentation/pixel_classes.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gfp {
namespace {

// A plane in floats for the loops below; the outline's edges as planes through which its prism is bounded.
struct Kernel {
  float up[3], camera_height, band, band_per_m2, max_height;
  std::uint8_t on, above;  // the class to give; 0: none
  std::vector<float> edges;  // x y z offset of each, the margin included
};

constexpr int kBlock = 64;
constexpr int kOnly = 1;             // near_plane() found pixels on the plane and none above
constexpr float kMinDepth = 0.05F;  // metres: no sensor of ours reads nearer

__attribute__((target_clones("arch=x86-64-v3", "default")))
void mark_valid(const float* z, int count, float min_depth, float max_depth, std::uint8_t* classes) {
  for (int i = 0; i < count; ++i) classes[i] = ((z[i] >= min_depth) & (z[i] <= max_depth)) ? kElsewhere : kInvalidPixel;
}

// Which of up to kBlock pixels are on (1) or above (2) the plane and still free; returns the union of these bits.
__attribute__((target_clones("arch=x86-64-v3", "default")))
int near_plane(const float* x, const float* y, const float* z, const float* ground, const std::uint8_t* classes, int count, const Kernel& k, std::uint8_t* near) {
  const float ux = k.up[0], uy = k.up[1], uz = k.up[2], offset = k.camera_height, band0 = k.band, band2 = k.band_per_m2, high = k.max_height;
  std::int32_t any = 0;
  for (int i = 0; i < count; ++i) {
    const float height = ux * x[i] + uy * y[i] + uz * z[i] + offset - ground[i];
    const float band = band0 + band2 * z[i] * z[i];
    const std::int32_t on = (height >= -band) & (height <= band), above = (height > band) & (height <= high);
    const std::int32_t free = classes[i] == kElsewhere;
    const std::int32_t value = (on + 2 * above) * free;
    near[i] = static_cast<std::uint8_t>(value);
    any |= value;
  }
  return any;
}

// Edges as four floats: direction and offset.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void clear_outside(const float* x, const float* y, const float* z, int count, const float* edges, std::size_t edge_count, std::uint8_t* near) {
  float least[kBlock];
  std::fill_n(least, kBlock, 0.0F);
  for (const float* e = edges; e != edges + 4 * edge_count; e += 4) {
    const float ex = e[0], ey = e[1], ez = e[2], offset = e[3];
    for (int i = 0; i < count; ++i) least[i] = std::min(least[i], ex * x[i] + ey * y[i] + ez * z[i] + offset);
  }
  for (int i = 0; i < count; ++i) near[i] = least[i] < 0.0F ? std::uint8_t{0} : near[i];
}

__attribute__((target_clones("arch=x86-64-v3", "default")))
void assign(const std::uint8_t* near, int count, std::uint8_t on, std::uint8_t above, std::uint8_t* classes) {
  for (int i = 0; i < count; ++i) {
    const std::uint8_t value = near[i] == 1 ? on : above;
    classes[i] = (near[i] != 0) & (value != 0) ? value : classes[i];
  }
}

// Per row, the columns [first, second) that surely see the inside of the outline where they see the plane: between the
// two edges of the outline's image, which is convex as well. Empty where the camera's distortion bends it.
std::vector<std::pair<int, int>> outline_spans(const OrganizedCloud& cloud, const FlatSurface& surface) {
  std::vector<std::pair<int, int>> spans(static_cast<std::size_t>(cloud.height), {0, 0});
  if (cloud.camera.distortion != DistortionModel::kNone) return spans;
  std::vector<Eigen::Vector2d> image;
  for (const Eigen::Vector3d& corner : surface.corners) {
    if (corner.z() < 0.05) return spans;
    image.push_back(cloud.camera.project(corner));
  }
  for (int v = 0; v < cloud.height; ++v) {
    double left = cloud.width, right = -1;
    for (std::size_t k = 0; k < image.size(); ++k) {
      const auto &a = image[k], &b = image[(k + 1) % image.size()];
      if ((a.y() <= v) == (b.y() <= v)) continue;
      const double u = a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      left = std::min(left, u);
      right = std::max(right, u);
    }
    spans[static_cast<std::size_t>(v)] = {static_cast<int>(std::ceil(std::clamp(left, 0.0, 1.0 * cloud.width))),
                                          static_cast<int>(std::floor(std::clamp(right, 0.0, 1.0 * cloud.width)))};
  }
  return spans;
}

// `inside`: the row's span of outline_spans(); `ground` is scratch, a row long; `classes` are the row's.
void apply_to_row(const OrganizedCloud& cloud, const FlatSurface& surface, const Kernel& kernel, int v, std::pair<int, int> inside,
                  std::vector<float>& ground, std::uint8_t* classes) {
  std::uint8_t near[kBlock];
  surface.ground.interpolate_row(v, cloud.width, ground.data());
  const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width);
  for (int u = 0; u < cloud.width; u += kBlock) {
    const int count = std::min(kBlock, cloud.width - u);
    const auto i = row + static_cast<std::size_t>(u);
    const float *x = &cloud.x[i], *y = &cloud.y[i], *z = &cloud.z[i];
    const int found = near_plane(x, y, z, &ground[static_cast<std::size_t>(u)], classes + u, count, kernel, near);
    if (found == 0) continue;
    const bool plain = found == kOnly && u >= inside.first && u + count <= inside.second;  // the usual case
    if (!plain) clear_outside(x, y, z, count, kernel.edges.data(), kernel.edges.size() / 4, near);
    assign(near, count, kernel.on, kernel.above, classes + u);
  }
}

void apply(const OrganizedCloud& cloud, const FlatSurface& surface, const Kernel& kernel, std::vector<std::uint8_t>& classes) {
  const auto spans = outline_spans(cloud, surface);
  constexpr int kRows = 32;  // of one task
  oneapi::tbb::parallel_for(0, cloud.height, kRows, [&](int begin) {
    std::vector<float> ground(static_cast<std::size_t>(cloud.width));
    for (int v = begin; v < std::min(begin + kRows, cloud.height); ++v)
      apply_to_row(cloud, surface, kernel, v, spans[static_cast<std::size_t>(v)], ground, &classes[static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width)]);
  });
}

Kernel kernel_of(const FlatSurface& surface, double max_height_m, double margin_m, int on, int above) {
  const Eigen::Vector3f up = surface.up.cast<float>();
  Kernel kernel{{up.x(), up.y(), up.z()}, static_cast<float>(surface.camera_height_m), static_cast<float>(surface.band_m),
                static_cast<float>(surface.band_per_m2), static_cast<float>(max_height_m), static_cast<std::uint8_t>(on), static_cast<std::uint8_t>(above), {}};
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    for (const double value : surface.edges[e]) kernel.edges.push_back(static_cast<float>(value));
    kernel.edges.push_back(static_cast<float>(surface.edge_offsets_m[e] + margin_m));
  }
  return kernel;
}

}  // namespace

std::vector<std::uint8_t> classify_pixels(const OrganizedCloud& cloud, const Supports& supports, const SegmentationOptions& options) {
  std::vector<std::uint8_t> classes(cloud.size());
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, cloud.size(), std::size_t{1} << 15), [&](const auto& range) {
    mark_valid(&cloud.z[range.begin()], static_cast<int>(range.size()), kMinDepth, static_cast<float>(options.max_depth_m), &classes[range.begin()]);
  });
  for (const FlatSurface& wall : supports.walls) apply(cloud, wall, kernel_of(wall, 0.0, options.edge_margin_m, kWall, 0), classes);
  std::vector<std::size_t> order(supports.surfaces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return supports.surfaces[a].camera_height_m < supports.surfaces[b].camera_height_m; });
  for (const auto k : order) {
    const int index = static_cast<int>(k);
    apply(cloud, supports.surfaces[k], kernel_of(supports.surfaces[k], options.max_height_m, options.edge_margin_m, kOnSupport + index, kAbove + index), classes);
  }
  return classes;
}

}  // namespace gfp
