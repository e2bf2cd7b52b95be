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

// Eight points in one register (two of SSE2's); the coordinates are that much longer than the points.
constexpr int kGroup = 8;
typedef float Floats __attribute__((vector_size(4 * kGroup), aligned(4), may_alias));
typedef std::int32_t Ints __attribute__((vector_size(4 * kGroup)));

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
  magnitude_ = low.cwiseAbs().maxCoeff();
  const Eigen::Vector3d size = high.cast<double>() - low.cast<double>();
  double cell = static_cast<double>(cell_m);
  const auto along = [&](int axis) { return std::floor(size[axis] / cell) + 2.0; };
  while (along(0) * along(1) * along(2) > static_cast<double>(kMaxCells)) cell *= 1.26;
  cell_m_ = static_cast<float>(cell);
  inverse_cell_ = 1.0F / cell_m_;
  for (int axis = 0; axis < 3; ++axis) cells_[static_cast<std::size_t>(axis)] = static_cast<int>(along(axis));

  start_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) * static_cast<std::size_t>(cells_[2]) + 1, 0);
  const std::size_t slab = static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]);
  std::vector<std::int64_t> cells(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) continue;
    ++size_;
    cells[i] = cell_of(points[i]);
    const auto cell_at = static_cast<std::size_t>(cells[i]);
    ++start_[cell_at + 1];
    if (cell_at >= slab) ++start_[cell_at - slab + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  for (auto* plane : {&x_, &y_, &z_}) plane->assign(static_cast<std::size_t>(start_.back()) + kGroup, 0.0F);
  std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
  const auto put = [&](const Eigen::Vector3f& p, std::size_t cell_at) {
    const auto at = static_cast<std::size_t>(next[cell_at]++);
    x_[at] = p.x();
    y_[at] = p.y();
    z_[at] = p.z();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cells[i] < 0) continue;
    const auto cell_at = static_cast<std::size_t>(cells[i]);
    put(points[i], cell_at);
    if (cell_at >= slab) put(points[i], cell_at - slab);
  }
}

/// Monotone in the coordinate, whatever its size, and never out of range.
inline int VoxelGrid::cell_along(int axis, float coordinate) const {
  const float cell = (coordinate - low_[axis]) * inverse_cell_, last = static_cast<float>(cells_[static_cast<std::size_t>(axis)] - 1);
  return static_cast<int>(std::clamp(cell, 0.0F, last));
}

std::int64_t VoxelGrid::cell_of(const Eigen::Vector3f& point) const {
  return (static_cast<std::int64_t>(cell_along(2, point.z())) * cells_[1] + cell_along(1, point.y())) * cells_[0] + cell_along(0, point.x());
}

namespace {

struct Sphere {
  float x, y, z, radius2;
};

/// Rows of cells along x: where the first row's first cell starts, the cells from one row and from one slab of rows to the next, and how
/// many rows, layers, and cells in a row there are. A slab holds two layers.
struct Rows {
  const std::int32_t* start;
  std::ptrdiff_t row, slab;
  int rows, layers, span;
};

/// How many of the points in the rows are inside the sphere.
__attribute__((target_clones("arch=x86-64-v3", "default")))
int count_in(const Rows& block, const float* x, const float* y, const float* z, const Sphere& sphere) {
  constexpr Ints kLane = {0, 1, 2, 3, 4, 5, 6, 7};
  const float px = sphere.x, py = sphere.y, pz = sphere.z, radius2 = sphere.radius2;
  const int layers = block.layers, rows = block.rows, span = block.span;
  Ints inside = {};
  for (int layer = 0; layer < layers; layer += 2)
    for (int row = 0; row < rows; ++row) {
      const std::int32_t* const start = block.start + layer * block.slab + row * block.row;
      const std::int32_t first = start[0], last = start[span];
      for (std::int32_t i = first; i < last; i += kGroup) {
        const auto at = [i](const float* plane) __attribute__((always_inline)) -> const Floats* { return reinterpret_cast<const Floats*>(plane + i); };
        const Floats dx = *at(x) - px, dy = *at(y) - py, dz = *at(z) - pz;
        inside -= (dx * dx + dy * dy + dz * dz <= radius2) & (kLane < last - i);
      }
    }
  int sum = 0;
  for (int k = 0; k < kGroup; ++k) sum += inside[k];
  return sum;
}

}  // namespace

int VoxelGrid::count_within(const Eigen::Vector3f& centre, float radius_m) const {
  const float reach = radius_m + kSlack * (radius_m + cell_m_ + std::abs(centre.x()) + std::abs(centre.y()) + std::abs(centre.z()) + magnitude_);
  if (size_ == 0 || !(radius_m >= 0) || !(reach < std::numeric_limits<float>::infinity())) return 0;
  const int x0 = cell_along(0, centre.x() - reach), y0 = cell_along(1, centre.y() - reach), z0 = cell_along(2, centre.z() - reach);
  const auto row = static_cast<std::ptrdiff_t>(cells_[0]), slab = row * cells_[1];
  const Rows rows{start_.data() + z0 * slab + y0 * row + x0, row, slab, cell_along(1, centre.y() + reach) - y0 + 1, cell_along(2, centre.z() + reach) - z0 + 1,
                  cell_along(0, centre.x() + reach) - x0 + 1};
  return count_in(rows, x_.data(), y_.data(), z_.data(), {centre.x(), centre.y(), centre.z(), radius_m * radius_m});
}

}  // namespace gfp
