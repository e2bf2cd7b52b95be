#include "gfp/core/voxel_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace gfp {
namespace {

/// Cells are picked with this much to spare, so that rounding never loses a point on the sphere.
constexpr float kSlack = 1e-5F;

bool is_finite(const Eigen::Vector3f& p) { return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()); }

/// Where a search is about.
struct Place {
  float x, y, z, radius2;
};

}  // namespace

VoxelGrid::VoxelGrid(std::span<const Eigen::Vector3f> points, float cell_m) {
  assert(cell_m > 0);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Eigen::Vector3f low = Eigen::Vector3f::Constant(kInfinity), high = -low;
  for (const auto& p : points) {
    if (!is_finite(p)) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!(low.x() <= high.x())) low = high = Eigen::Vector3f::Zero();
  low_ = low;
  const Eigen::Vector3d size = high.cast<double>() - low.cast<double>();
  double cell = static_cast<double>(cell_m);
  const auto along = [&](int axis) { return std::floor(size[axis] / cell) + 2.0; };
  while (along(0) * along(1) * along(2) > static_cast<double>(kMaxCells)) cell *= 1.26;
  cell_m_ = static_cast<float>(cell);
  inverse_cell_ = 1.0F / cell_m_;
  for (int axis = 0; axis < 3; ++axis) cells_[static_cast<std::size_t>(axis)] = static_cast<int>(along(axis));

  start_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(cells_[2]) + 1, 0);
  std::vector<std::int64_t> cells(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) continue;
    cells[i] = cell_of(points[i]);
    ++start_[static_cast<std::size_t>(cells[i]) + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  const auto kept = static_cast<std::size_t>(start_.back());
  for (auto* plane : {&x_, &y_, &z_}) plane->resize(kept);
  index_.resize(kept);
  std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cells[i] < 0) continue;
    const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(cells[i])]++);
    x_[at] = points[i].x();
    y_[at] = points[i].y();
    z_[at] = points[i].z();
    index_[at] = static_cast<std::int32_t>(i);
  }
}

/// Monotone in the coordinate, whatever its size, and never out of range.
int VoxelGrid::cell_along(int axis, float coordinate) const {
  const float cell = (coordinate - low_[axis]) * inverse_cell_, last = static_cast<float>(cells_[static_cast<std::size_t>(axis)] - 1);
  return static_cast<int>(std::clamp(cell, 0.0F, last));
}

std::int64_t VoxelGrid::cell_of(const Eigen::Vector3f& point) const {
  return (static_cast<std::int64_t>(cell_along(2, point.z())) * cells_[1] + cell_along(1, point.y())) * cells_[0] + cell_along(0, point.x());
}

/// The rows of cells along x that a search has to look at, as the loops below need them.
struct VoxelGrid::Block {
  const std::int32_t* start;          ///< Of the first row's first cell of interest.
  std::ptrdiff_t row, layer;          ///< Cells from one row, and from one layer of rows, to the next.
  int rows, layers, span;             ///< Of the block; cells of interest in a row.
  float low_y, low_z, cell, reach2;   ///< Where the first row and layer begin; what the rows' distances are compared with.
};

VoxelGrid::Block VoxelGrid::block_around(const Eigen::Vector3f& centre, float radius_m) const {
  if (index_.empty() || !is_finite(centre) || !(radius_m >= 0)) return {start_.data(), 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const float reach = radius_m + kSlack * (radius_m + cell_m_ + centre.cwiseAbs().maxCoeff() + low_.cwiseAbs().maxCoeff());
  const int x0 = cell_along(0, centre.x() - reach), y0 = cell_along(1, centre.y() - reach), z0 = cell_along(2, centre.z() - reach);
  const auto row = static_cast<std::ptrdiff_t>(cells_[0]), layer = row * cells_[1];
  return {start_.data() + z0 * layer + y0 * row + x0,
          row,
          layer,
          cell_along(1, centre.y() + reach) - y0 + 1,
          cell_along(2, centre.z() + reach) - z0 + 1,
          cell_along(0, centre.x() + reach) - x0 + 1,
          low_.y() + static_cast<float>(y0) * cell_m_,
          low_.z() + static_cast<float>(z0) * cell_m_,
          cell_m_,
          reach * reach};
}

namespace {

/// From `place` to the slab [lower, lower + cell].
inline float gap_to(float place, float lower, float cell) {
  const float below = lower - place, above = place - (lower + cell), outside = below > above ? below : above;
  return outside > 0.0F ? outside : 0.0F;
}

/// Calls visit(first, count) for the runs of points in the block's rows that are near enough.
template <class Block, class Visit>
inline __attribute__((always_inline)) void for_each_run(const Block& block, const Place& place, Visit&& visit) {
  for (int z = 0; z < block.layers; ++z) {
    const float gap_z = gap_to(place.z, block.low_z + static_cast<float>(z) * block.cell, block.cell), left_z = block.reach2 - gap_z * gap_z;
    for (int y = 0; y < block.rows; ++y) {
      const std::int32_t* const start = block.start + z * block.layer + y * block.row;
      const std::int32_t first = start[0], count = start[block.span] - first;
      const float gap_y = gap_to(place.y, block.low_y + static_cast<float>(y) * block.cell, block.cell);
      if (count > 0 && gap_y * gap_y <= left_z) visit(first, count);
    }
  }
}

template <class Block>
__attribute__((target_clones("arch=x86-64-v3", "default")))
int count_in(const Block& block, const float* x, const float* y, const float* z, const Place& place) {
  int inside = 0;
  const float px = place.x, py = place.y, pz = place.z, radius2 = place.radius2;
  for_each_run(block, place, [&](std::int32_t first, int count) __attribute__((always_inline)) {
    const float *rx = x + first, *ry = y + first, *rz = z + first;
    for (int i = 0; i < count; ++i) {
      const float dx = rx[i] - px, dy = ry[i] - py, dz = rz[i] - pz;
      inside += dx * dx + dy * dy + dz * dz <= radius2 ? 1 : 0;
    }
  });
  return inside;
}

/// Writes every candidate and advances past those inside: no branch to mispredict. `out` has room for all candidates.
template <class Block>
__attribute__((target_clones("arch=x86-64-v3", "default")))
std::size_t find_in(const Block& block, const float* x, const float* y, const float* z, const std::int32_t* index, const Place& place, Neighbour* out) {
  constexpr int kChunk = 64;
  float squared[kChunk];
  std::size_t kept = 0;
  const float px = place.x, py = place.y, pz = place.z, radius2 = place.radius2;
  for_each_run(block, place, [&](std::int32_t first, int count) __attribute__((always_inline)) {
    for (int done = 0; done < count; done += kChunk) {
      const std::int32_t at = first + done;
      const int chunk = count - done < kChunk ? count - done : kChunk;
      for (int i = 0; i < chunk; ++i) {
        const float dx = x[at + i] - px, dy = y[at + i] - py, dz = z[at + i] - pz;
        squared[i] = dx * dx + dy * dy + dz * dz;
      }
      for (int i = 0; i < chunk; ++i) {
        out[kept] = {index[at + i], squared[i]};
        kept += squared[i] <= radius2 ? 1 : 0;
      }
    }
  });
  return kept;
}

}  // namespace

int VoxelGrid::count_within(const Eigen::Vector3f& centre, float radius_m) const {
  return count_in(block_around(centre, radius_m), x_.data(), y_.data(), z_.data(), {centre.x(), centre.y(), centre.z(), radius_m * radius_m});
}

std::span<const Neighbour> VoxelGrid::find_within(const Eigen::Vector3f& centre, float radius_m, std::vector<Neighbour>& buffer) const {
  const Block block = block_around(centre, radius_m);
  const Place place{centre.x(), centre.y(), centre.z(), radius_m * radius_m};
  std::size_t candidates = 0;
  for_each_run(block, place, [&](std::int32_t, int count) { candidates += static_cast<std::size_t>(count); });
  if (buffer.size() < candidates) buffer.resize(candidates);
  return {buffer.data(), find_in(block, x_.data(), y_.data(), z_.data(), index_.data(), place, buffer.data())};
}

std::optional<Neighbour> VoxelGrid::nearest(const Eigen::Vector3f& centre, float radius_m) const {
  for (float reach = std::min(cell_m_, radius_m);; reach = std::min(2 * reach, radius_m)) {
    const Place place{centre.x(), centre.y(), centre.z(), reach * reach};
    Neighbour best{-1, place.radius2};
    for_each_run(block_around(centre, reach), place, [&](std::int32_t first, int count) {
      for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(first) + static_cast<std::size_t>(count); ++i) {
        const float dx = x_[i] - place.x, dy = y_[i] - place.y, dz = z_[i] - place.z, squared = dx * dx + dy * dy + dz * dz;
        const bool nearer = squared < best.squared_m2, tie = squared == best.squared_m2;
        if (nearer || (tie && (best.index < 0 || index_[i] < best.index))) best = {index_[i], squared};
      }
    });
    if (best.index >= 0) return best;
    if (!(reach < radius_m)) return std::nullopt;
  }
}

}  // namespace gfp
