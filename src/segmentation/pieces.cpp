#include "segmentation/pieces.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "gfp/core/box_normals.hpp"

namespace gfp {
namespace {

constexpr int kNormalRadius = 3;
constexpr int kSpan = 4;                  // a crease is looked for between normals this many pixels to either side
constexpr float kCreaseCos = 0.88F;       // 28 deg
constexpr float kStepShare = 0.5F;        // of the cluster tolerance: a step of depth that ends a surface
constexpr int kMinPiece = 40;             // pixels; less is noise at a cut

constexpr int kMargin = kSpan;            // pixels of the grid around a cluster's box: nothing looks farther

/// A piece before all clusters are cut.
struct Cut {
  PixelList pixels;
  bool left_over = false;  // connected only by steps that end a surface
};

/// Where a row of depths (NaN: not of the cluster) has a step to the right or down: more than the surface's own slope explains, by the
/// second difference across the pixel. The rows above and below are `stride` before and behind.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void mark_steps(const float* z, std::int32_t stride, float tolerance, std::uint8_t* __restrict step) {
  const auto is_step = [&](std::int32_t c, std::int32_t d, float limit) __attribute__((always_inline)) {
    const float rise = z[c + d] - z[c];
    return (std::abs(rise) > limit) & !(std::abs(rise - (z[c] - z[c - d])) <= limit);
  };
  for (std::int32_t c = 1; c + 1 < stride; ++c) {
    const float square = z[c] * z[c], limit = tolerance * (square > 1.0F ? square : 1.0F);
    step[c] = static_cast<std::uint8_t>(is_step(c, 1, limit) | is_step(c, stride, limit));
  }
}

/// Cuts one cluster, on a grid of its own with a margin all around: no neighbour is ever outside, and all of it stays in the cache.
class Cutter {
 public:
  Cutter(const OrganizedCloud& cloud, const PixelList& cluster, const PixelRect& box, double tolerance_m, const PieceMap& normals)
      : cloud_(cloud), map_(normals), tolerance_(static_cast<float>(tolerance_m)), stride_(box.width() + 2 * kMargin), height_(box.height() + 2 * kMargin) {
    const auto cells = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_);
    inside_.assign(cells, 0);
    z_.assign(cells, std::numeric_limits<float>::quiet_NaN());
    cells_.resize(cluster.size());
    int v = box.v0, row = box.v0 * cloud.width;
    for (std::size_t k = 0; k < cluster.size(); ++k) {
      const std::int32_t i = cluster[k];
      for (; i >= row + cloud.width; row += cloud.width) ++v;
      const std::int32_t c = (v - box.v0 + kMargin) * stride_ + (i - row) - box.u0 + kMargin;
      cells_[k] = {c, i, ((i - row) & 1) != 0, (v & 1) != 0};
      inside_[index(c)] = 1;
      z_[index(c)] = cloud.z[index(i)];
    }
  }

  std::vector<Cut> run() {
    std::vector<std::uint8_t> open(inside_.size(), 0);
    crease_.assign(inside_.size(), 0);
    std::vector<std::uint8_t> step(inside_.size(), 0);
    for (int row = kMargin; row < height_ - kMargin; ++row) mark_steps(&z_[index(row * stride_)], stride_, kStepShare * tolerance_, &step[index(row * stride_)]);
    for (const Cell& cell : cells_) open[index(cell.c)] = step[index(cell.c)] == 0 && !near_crease(cell);
    piece_.assign(inside_.size(), -1);
    const DepthGrid depth{z_.data(), stride_, height_, 0};
    for (const PixelList& component : connected_components(depth, open, open, {kStepShare * tolerance_, 0.0}, kMinPiece)) add(component, false);
    grow_back();
    for (const Cell& cell : cells_) open[index(cell.c)] = piece_[index(cell.c)] < 0;
    for (const PixelList& component : connected_components(depth, open, open, {2.0 * static_cast<double>(tolerance_), 0.0}, 1)) add(component, true);
    for (const Cell& cell : cells_) cuts_[index(piece_[index(cell.c)])].pixels.push_back(cell.i);
    return std::move(cuts_);
  }

 private:
  struct Cell {
    std::int32_t c, i;  // in the grid, in the image
    bool odd_column, odd_row;
  };
  static std::size_t index(std::int32_t k) { return static_cast<std::size_t>(k); }
  bool inside(std::int32_t c) const { return inside_[index(c)] != 0; }
  float z(std::int32_t c) const { return z_[index(c)]; }
  float step_limit(std::int32_t c) const { return kStepShare * tolerance_ * std::max(1.0F, z(c) * z(c)); }

  // Creases are bands as wide as the span: every second pixel of every second row tells for its neighbours (which come later).
  bool near_crease(const Cell& cell) {
    const std::int32_t anchor = cell.c - (cell.odd_column ? 1 : 0) - (cell.odd_row ? stride_ : 0);
    if (anchor != cell.c && inside(anchor)) return crease_[index(anchor)] != 0;
    const bool crease = is_crease(cell);
    crease_[index(cell.c)] = crease;
    return crease;
  }

  bool is_crease(const Cell& cell) const {
    constexpr std::array<std::array<int, 2>, 4> kDirections = {{{kSpan, 0}, {0, kSpan}, {kSpan - 1, kSpan - 1}, {kSpan - 1, 1 - kSpan}}};
    const float limit = 4.0F * step_limit(cell.c);
    for (const auto& [du, dv] : kDirections) {
      const std::int32_t here = dv * stride_ + du, there = dv * cloud_.width + du;
      if (!inside(cell.c + here) || !inside(cell.c - here) || std::abs(z(cell.c + here) - z(cell.c - here)) > limit) continue;
      const Eigen::Vector3f na = map_.normal(cell.i + there), nb = map_.normal(cell.i - there);
      if (!(na.dot(nb) < kCreaseCos)) continue;
      const Eigen::Vector3f between = cloud_.point(index(cell.i + there)) - cloud_.point(index(cell.i - there));
      if ((na - nb).dot(between) < 0.0F) return true;
    }
    return false;
  }

  void add(const PixelList& component, bool left_over) {
    for (const std::int32_t c : component) piece_[index(c)] = static_cast<std::int32_t>(cuts_.size());
    cuts_.push_back({{}, left_over});
  }

  // Breadth first from all pieces at once, so that a cut is shared out evenly; never across a step of depth.
  void grow_back() {
    std::vector<std::int32_t> frontier, next;
    for (const Cell& cell : cells_)  // those of the pieces that have somewhere to grow to
      if (piece_[index(cell.c)] < 0)
        for (const std::int32_t n : {cell.c + 1, cell.c - 1, cell.c + stride_, cell.c - stride_})
          if (piece_[index(n)] >= 0) frontier.push_back(n);
    std::sort(frontier.begin(), frontier.end());
    frontier.erase(std::unique(frontier.begin(), frontier.end()), frontier.end());
    while (!frontier.empty()) {
      next.clear();
      for (const std::int32_t c : frontier) {
        const float limit = 2.0F * step_limit(c);
        for (const std::int32_t n : {c + 1, c - 1, c + stride_, c - stride_}) {
          if (!inside(n) || piece_[index(n)] >= 0 || std::abs(z(n) - z(c)) > limit) continue;
          piece_[index(n)] = piece_[index(c)];
          next.push_back(n);
        }
      }
      frontier.swap(next);
    }
  }

  const OrganizedCloud& cloud_;
  const PieceMap& map_;
  float tolerance_;
  std::int32_t stride_, height_;
  std::vector<Cell> cells_;  // of the cluster, ascending
  std::vector<std::uint8_t> inside_, crease_;
  std::vector<float> z_;
  std::vector<std::int32_t> piece_;
  std::vector<Cut> cuts_;
};

void estimate_normals(const OrganizedCloud& cloud, const std::vector<PixelRect>& boxes, PieceMap& map) {
  const DepthPlanes depth{cloud.width, cloud.height, cloud.x.data(), cloud.y.data(), cloud.z.data(),
                          cloud.camera.fx, cloud.camera.fy, cloud.camera.cx, cloud.camera.cy, cloud.camera.distortion == DistortionModel::kNone};
  for (auto* plane : {&map.nx, &map.ny, &map.nz}) *plane = std::make_unique_for_overwrite<float[]>(cloud.size());
  for (const PixelRect& box : boxes) box_normals(depth, {kNormalRadius, 0.02F, true}, box, map.nx.get(), map.ny.get(), map.nz.get());
}

}  // namespace

PieceMap cut_into_pieces(const OrganizedCloud& cloud, const std::vector<PixelList>& clusters, double tolerance_m) {
  PieceMap map;
  std::vector<PixelRect> boxes;
  for (const PixelList& cluster : clusters) boxes.push_back(bounding_box(cluster, cloud.width));
  estimate_normals(cloud, boxes, map);
  std::vector<std::vector<Cut>> cuts(clusters.size());
  oneapi::tbb::parallel_for(std::size_t{0}, clusters.size(), [&](std::size_t k) { cuts[k] = Cutter(cloud, clusters[k], boxes[k], tolerance_m, map).run(); });
  std::vector<std::pair<Cut*, int>> all;
  for (std::size_t k = 0; k < cuts.size(); ++k)
    for (Cut& cut : cuts[k]) all.emplace_back(&cut, static_cast<int>(k));
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first->left_over, a.first->pixels.front()) < std::pair(b.first->left_over, b.first->pixels.front());
  });
  map.piece.assign(cloud.size(), -1);
  for (const auto& [cut, cluster] : all) {
    for (const std::int32_t i : cut->pixels) map.piece[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(map.pixels.size());
    map.pixels.push_back(std::move(cut->pixels));
    map.cluster.push_back(cluster);
  }
  return map;
}

}  // namespace gfp
