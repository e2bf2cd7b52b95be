#include "recognition/view_descriptor.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr int kBands = 6;  ///< Of height.

struct Range {
  double low = 1e300, high = -1e300;
  void include(double value) { low = std::min(low, value); high = std::max(high, value); }
  double length() const { return std::max(0.0, high - low); }
};

double quantile(std::vector<double> values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

}  // namespace

ViewDescriptor describe_view(const std::vector<SeenPoint>& points, double azimuth) {
  const Vector3d sight(std::cos(azimuth), std::sin(azimuth), 0), lateral(-std::sin(azimuth), std::cos(azimuth), 0);
  std::vector<double> across, along, heights;
  for (const auto& p : points) {
    across.push_back(lateral.dot(p.point));
    along.push_back(sight.dot(p.point));
    heights.push_back(p.point.z());
  }
  const double left = quantile(across, 0.01), right = quantile(across, 0.99), near = quantile(along, 0.01), far = quantile(along, 0.99);
  const double height = std::max(0.003, quantile(heights, 0.995)), width = std::max(0.003, right - left), depth = std::max(0.003, far - near);

  Range band_width[kBands], band_depth[kBands];
  double band_centre[kBands] = {}, band_count[kBands] = {};
  double upward = 0, sideways = 0, facing = 0, with_normal = 0, spread_x = 0, spread_y = 0, mean_across = 0, steepness = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto band = static_cast<std::size_t>(std::clamp(static_cast<int>(kBands * heights[k] / height), 0, kBands - 1));
    band_width[band].include(std::clamp(across[k], left, right));
    band_depth[band].include(std::clamp(along[k], near, far));
    band_centre[band] += across[k];
    ++band_count[band];
    mean_across += across[k] / static_cast<double>(points.size());
    const Vector3d& normal = points[k].normal;
    if (normal.squaredNorm() < 0.5) continue;
    ++with_normal;
    upward += normal.z() > 0.85 ? 1 : 0;
    sideways += std::abs(normal.z()) < 0.25 ? 1 : 0;
    steepness += normal.z();
    const double toward = -normal.dot(sight), beside = normal.dot(lateral);
    facing += toward;
    // Double angle: the two faces of a box give two directions, a cylinder all of them.
    const double angle = std::atan2(beside, toward), horizontal = std::hypot(toward, beside);
    spread_x += horizontal * std::cos(4 * angle);
    spread_y += horizontal * std::sin(4 * angle);
  }
  with_normal = std::max(1.0, with_normal);

  ViewDescriptor d;
  int n = 0;
  d[n++] = 3 * std::log(height);
  d[n++] = 3 * std::log(width);
  d[n++] = 2 * std::log(depth);
  d[n++] = 3 * std::log(width / height);
  const double middle = 0.5 * (left + right);
  double last_centre = middle;
  for (int b = 0; b < kBands; ++b) {
    const bool seen = band_count[b] > 0;
    const double centre = seen ? band_centre[b] / band_count[b] : last_centre;
    last_centre = centre;
    d[n++] = seen ? band_width[b].length() / width : 0;
    d[n++] = seen ? band_depth[b].length() / width : 0;
    d[n++] = std::abs(centre - middle) / width;
  }
  d[n++] = upward / with_normal;
  d[n++] = sideways / with_normal;
  d[n++] = facing / with_normal;
  d[n++] = steepness / with_normal;
  d[n++] = std::hypot(spread_x, spread_y) / with_normal;
  d[n++] = std::abs(mean_across - middle) / width;
  return d;
}

}  // namespace gfp
