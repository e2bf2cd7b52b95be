#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "gfp/memory/associate.hpp"

namespace gfp {
namespace {

/// What two views of one object have in common, pixel by pixel.
struct Comparison {
  int both = 0, outliers = 0;
  double shift_sigmas = 0;  // mean change of depth in standard deviations of one reading
};

Eigen::Vector2d mask_centre(const ObjectView& view) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int j = 0; j < view.tile.height(); ++j)
    for (int i = 0; i < view.tile.width(); ++i)
      if (view.evidence.at(i, j) == Evidence::kObject) sum += Eigen::Vector2d(view.tile.u0 + i, view.tile.v0 + j);
  return sum / std::max(1, view.object_pixels);
}

Comparison compare(const ObjectView& now, const ObjectView& before) {
  Comparison result;
  for (int j = 0; j < now.tile.height(); ++j) {
    for (int i = 0; i < now.tile.width(); ++i) {
      const int u = now.tile.u0 + i, v = now.tile.v0 + j;
      if (now.evidence.at(i, j) != Evidence::kObject || !before.tile.contains(u, v)) continue;
      const int bi = u - before.tile.u0, bj = v - before.tile.v0;
      if (before.evidence.at(bi, bj) != Evidence::kObject) continue;
      const double z = now.depth_m.at(i, j);
      const double sigmas = (z - before.depth_m.at(bi, bj)) / now.noise.sigma_m(z);
      ++result.both;
      result.shift_sigmas += sigmas;
      result.outliers += std::abs(sigmas) > 4 * std::numbers::sqrt2;
    }
  }
  result.shift_sigmas /= std::max(1, result.both);
  return result;
}

}  // namespace

bool same_within_noise(const ObjectView& now, const ObjectView& before, const AssociateOptions& options) {
  constexpr double kMaxOutlierShare = 0.05;  // silhouettes and flying pixels flicker on things that stand still
  if (now.camera != before.camera || now.occluded != before.occluded || now.touches_border != before.touches_border ||
      now.has_support != before.has_support)
    return false;
  const Comparison c = compare(now, before);
  const int either = now.object_pixels + before.object_pixels - c.both;
  if (c.both == 0 || c.both < options.unchanged_iou * either) return false;
  if (c.outliers > kMaxOutlierShare * c.both) return false;
  if (std::abs(c.shift_sigmas) > options.unchanged_sigmas) return false;
  return (mask_centre(now) - mask_centre(before)).norm() <= options.unchanged_shift_px;
}

}  // namespace gfp
