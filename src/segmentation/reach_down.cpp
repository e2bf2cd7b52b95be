#include "segmentation/reach_down.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "segmentation/pixel_classes.hpp"

namespace gfp {
namespace {

constexpr int kHalfWindow = 2;       ///< Pixels: 5 x 5 readings err by about a third of one, for neighbours err together.
constexpr int kLeastReadings = 6;
constexpr double kBandShare = 0.4;   ///< Of the surface's band, which is three sigmas of one reading: as many of the mean.
constexpr int kReach = 40;           ///< Pixels: a foot is no wider, but a warped table might be.

/// Which pixels of a row are above a support and have a neighbour on it: right, left, below or above.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void mark_feet(const std::uint8_t* row, const std::uint8_t* above, const std::uint8_t* below, int count,
                                                                           std::uint8_t* __restrict feet) {
  constexpr int kDrop = kAbove - kOnSupport;
  for (int u = 1; u + 1 < count; ++u) {
    const auto on = static_cast<std::uint8_t>(row[u] - kDrop);
    feet[u] = static_cast<std::uint8_t>((row[u] >= kAbove) & ((row[u - 1] == on) | (row[u + 1] == on) | (above[u] == on) | (below[u] == on)));
  }
}

class FootSearch {
 public:
  FootSearch(const OrganizedCloud& cloud, const Supports& supports, std::vector<std::uint8_t>& classes)
      : cloud_(cloud), supports_(supports), classes_(classes), seen_(classes.size(), 0) {}

  void run() {
    std::vector<std::int32_t> ring;
    std::vector<std::uint8_t> feet(static_cast<std::size_t>(cloud_.width), 1);  // at either end of a row it may as well be one
    for (int v = 0; v < cloud_.height; ++v) {
      const std::uint8_t* row = &at(v * cloud_.width);
      mark_feet(row, v > 0 ? row - cloud_.width : row, v + 1 < cloud_.height ? row + cloud_.width : row, cloud_.width, feet.data());
      for (auto foot = std::find(feet.begin(), feet.end(), 1); foot != feet.end(); foot = std::find(foot + 1, feet.end(), 1))
        if (const auto u = static_cast<int>(foot - feet.begin()); row[u] >= kAbove) visit_neighbours(u, v, ring);
    }
    for (int step = 0; step < kReach && !ring.empty(); ++step) {
      std::vector<std::uint8_t> out(ring.size());
      constexpr std::size_t kChunk = 256;
      oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, ring.size(), kChunk), [&](const auto& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) out[k] = stands_out(ring[k]);
      });
      std::vector<std::int32_t> joined, next;
      for (std::size_t k = 0; k < ring.size(); ++k)
        if (out[k] != 0) joined.push_back(ring[k]);
      for (const std::int32_t pixel : joined) at(pixel) = static_cast<std::uint8_t>(at(pixel) - kOnSupport + kAbove);
      for (const std::int32_t pixel : joined) visit_neighbours(pixel % cloud_.width, pixel / cloud_.width, next);
      ring = std::move(next);
    }
  }

 private:
  std::uint8_t& at(std::int32_t pixel) { return classes_[static_cast<std::size_t>(pixel)]; }

  /// Neighbours on the support that this pixel is above join `ring`, each once.
  void visit_neighbours(int u, int v, std::vector<std::int32_t>& ring) {
    const std::int32_t pixel = v * cloud_.width + u;
    const auto visit = [&](std::int32_t neighbour) {
      if (at(neighbour) != at(pixel) - kAbove + kOnSupport || seen_[static_cast<std::size_t>(neighbour)]) return;
      seen_[static_cast<std::size_t>(neighbour)] = 1;
      ring.push_back(neighbour);
    };
    if (u > 0) visit(pixel - 1);
    if (u + 1 < cloud_.width) visit(pixel + 1);
    if (v > 0) visit(pixel - cloud_.width);
    if (v + 1 < cloud_.height) visit(pixel + cloud_.width);
  }

  /// Over readings on the same support only: those above it would lift the mean of the plain table beside them.
  bool stands_out(std::int32_t pixel) const {
    const std::uint8_t on = classes_[static_cast<std::size_t>(pixel)];
    const FlatSurface& surface = supports_.surfaces[static_cast<std::size_t>(on - kOnSupport)];
    const int u = pixel % cloud_.width, v = pixel / cloud_.width;
    const Eigen::Vector3f up = surface.up.cast<float>();
    const float offset = static_cast<float>(surface.camera_height_m) - surface.ground.at(u, v);  // the ground is flat over the window
    float sum = 0;
    int count = 0;
    for (int y = std::max(0, v - kHalfWindow); y <= std::min(cloud_.height - 1, v + kHalfWindow); ++y) {
      for (int x = std::max(0, u - kHalfWindow); x <= std::min(cloud_.width - 1, u + kHalfWindow); ++x) {
        const std::int32_t other = y * cloud_.width + x;
        if (classes_[static_cast<std::size_t>(other)] != on) continue;
        sum += up.dot(cloud_.point(static_cast<std::size_t>(other))) + offset;
        ++count;
      }
    }
    const double z = static_cast<double>(cloud_.z[static_cast<std::size_t>(pixel)]);
    return count >= kLeastReadings && static_cast<double>(sum) > kBandShare * surface.band(z) * count;
  }

  const OrganizedCloud& cloud_;
  const Supports& supports_;
  std::vector<std::uint8_t>& classes_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace

void reach_down(const OrganizedCloud& cloud, const Supports& supports, std::vector<std::uint8_t>& classes) { FootSearch(cloud, supports, classes).run(); }

}  // namespace gfp
