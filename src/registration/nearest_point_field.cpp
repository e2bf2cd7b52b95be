#include "registration/nearest_point_field.hpp"

#include <algorithm>
#include <utility>

#include "gfp/core/mesh.hpp"

namespace gfp {

NearestPointField::NearestPointField(std::vector<Eigen::Vector3d> points, double margin_m)
    : points_(std::move(points)), point_(static_cast<std::size_t>(kSide) * kSide * kSide, -1) {
  const Bounds box = bounds(points_);
  cell_m_ = std::max(1e-9, (box.size().maxCoeff() + 2 * margin_m) / kSide);
  low_ = box.centre() - Eigen::Vector3d::Constant(0.5 * kSide * cell_m_);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d at = (points_[i] - low_) / cell_m_;
    const auto along = [&](int axis) { return std::clamp(static_cast<int>(at[axis]), 0, kSide - 1); };
    offer(along(0), along(1), along(2), static_cast<std::int32_t>(i));
  }
  for (const int direction : {1, -1, 1, -1}) sweep(direction);
}

void NearestPointField::offer(int x, int y, int z, std::int32_t point) {
  std::int32_t& held = point_[cell(x, y, z)];
  if (point < 0 || point == held) return;
  const Eigen::Vector3d here = middle(x, y, z);
  if (held < 0 || (points_[static_cast<std::size_t>(point)] - here).squaredNorm() < (points_[static_cast<std::size_t>(held)] - here).squaredNorm()) held = point;
}

/// Carries points forwards (1) or backwards (-1) through the cells, from the 13 neighbours that the sweep has passed.
void NearestPointField::sweep(int direction) {
  const int first = direction > 0 ? 0 : kSide - 1;
  const auto inside = [](int c) { return c >= 0 && c < kSide; };
  for (int k = 0, z = first; k < kSide; ++k, z += direction)
    for (int j = 0, y = first; j < kSide; ++j, y += direction)
      for (int i = 0, x = first; i < kSide; ++i, x += direction)
        for (int dz = -1; dz <= 0; ++dz)
          for (int dy = -1; dy <= (dz < 0 ? 1 : 0); ++dy)
            for (int dx = -1; dx <= (dz < 0 || dy < 0 ? 1 : -1); ++dx) {
              const int nx = x + direction * dx, ny = y + direction * dy, nz = z + direction * dz;
              if (inside(nx) && inside(ny) && inside(nz)) offer(x, y, z, point_[cell(nx, ny, nz)]);
            }
}

std::size_t NearestPointField::nearest(const Eigen::Vector3d& place) const {
  const Eigen::Vector3d at = ((place - low_) / cell_m_).cwiseMax(0.0).cwiseMin(kSide - 1.0);
  return static_cast<std::size_t>(point_[cell(static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z()))]);
}

}  // namespace gfp
