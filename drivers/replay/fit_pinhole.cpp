#include "replay/fit_pinhole.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gfp {
namespace {

constexpr int kMinReadings = 100;

/// Straight line ratio = slope * pixel + offset by least squares, its error expressed in pixels.
struct Line {
  double slope = 0, offset = 0;
  double rms_px = std::numeric_limits<double>::infinity();
  double focal_px() const { return 1.0 / slope; }
  double centre_px() const { return -offset / slope; }
};

/// Sums for one coordinate divided by the forward coordinate, against columns and rows. Pixels are counted from the
/// image's centre, which keeps the sums well conditioned.
struct Sums {
  double n = 0, p = 0, pp = 0, r = 0, rr = 0, pr = 0;

  void add(double pixel, double ratio) {
    n += 1, p += pixel, pp += pixel * pixel, r += ratio, rr += ratio * ratio, pr += pixel * ratio;
  }
  Line line() const {
    const double spread_p = pp - p * p / n, spread_r = rr - r * r / n, joint = pr - p * r / n;
    if (!(spread_p > 0) || !(std::abs(joint) > 0)) return {};
    Line line;
    line.slope = joint / spread_p;
    line.offset = (r - line.slope * p) / n;
    line.rms_px = std::sqrt(std::max(0.0, spread_r - joint * joint / spread_p) / n) / std::abs(line.slope);
    return line;
  }
};

/// The fit with file axis `forward` as depth, `right` along the columns and `down` along the rows; signs as they come.
struct Candidate {
  Axes axes;
  Line right, down;
  int readings = 0;
  double rms_px() const { return std::hypot(right.rms_px, down.rms_px); }
};

bool is_reading(const PcdCloud& cloud, std::size_t i, std::size_t forward) {
  return std::isfinite(cloud.xyz[0][i]) && std::isfinite(cloud.xyz[1][i]) && std::isfinite(cloud.xyz[2][i]) && cloud.xyz[forward][i] != 0;
}

/// +1 or -1 where nearly all readings lie on that side of the camera, 0 where they lie on both.
int forward_sign(const PcdCloud& cloud, std::size_t forward) {
  std::int64_t positive = 0, negative = 0;
  for (std::size_t i = 0; i < cloud.xyz[forward].size(); ++i)
    if (is_reading(cloud, i, forward)) ++(cloud.xyz[forward][i] > 0 ? positive : negative);
  constexpr std::int64_t kStrays = 1000;  // one in so many may be a damaged reading
  if (positive > kStrays * negative) return 1;
  return negative > kStrays * positive ? -1 : 0;
}

Candidate fit_candidate(const PcdCloud& cloud, std::size_t right, std::size_t down, std::size_t forward, int sign) {
  Sums columns, rows;
  std::size_t i = 0;
  for (int v = 0; v < cloud.height; ++v)
    for (int u = 0; u < cloud.width; ++u, ++i) {
      const double depth = sign * static_cast<double>(cloud.xyz[forward][i]);
      if (!is_reading(cloud, i, forward) || depth < 0) continue;
      columns.add(u - 0.5 * cloud.width, cloud.xyz[right][i] / depth);
      rows.add(v - 0.5 * cloud.height, cloud.xyz[down][i] / depth);
    }
  Candidate candidate;
  candidate.readings = static_cast<int>(columns.n);
  if (candidate.readings < kMinReadings) return candidate;
  candidate.right = columns.line(), candidate.down = rows.line();
  candidate.axes.index = {static_cast<int>(right), static_cast<int>(down), static_cast<int>(forward)};
  candidate.axes.sign = {candidate.right.slope < 0 ? -1 : 1, candidate.down.slope < 0 ? -1 : 1, sign};
  return candidate;
}

Candidate best_candidate(const PcdCloud& cloud, const std::optional<Axes>& axes) {
  Candidate best;
  for (std::size_t forward = 0; forward < 3; ++forward) {
    const int sign = forward_sign(cloud, forward);
    if (sign == 0) continue;
    for (std::size_t k = 1; k <= 2; ++k) {
      const Candidate candidate = fit_candidate(cloud, (forward + k) % 3, (forward + 3 - k) % 3, forward, sign);
      if (axes && candidate.axes != *axes) continue;
      if (best.readings == 0 || candidate.rms_px() < best.rms_px()) best = candidate;
    }
  }
  return best;
}

int count_readings(const PcdCloud& cloud) {
  int readings = 0;
  for (std::size_t i = 0; i < cloud.xyz[0].size(); ++i)
    readings += is_reading(cloud, i, 2) || is_reading(cloud, i, 0) ? 1 : 0;
  return readings;
}

}  // namespace

Result<PinholeFit> fit_pinhole(const PcdCloud& cloud, const std::optional<Axes>& axes, std::string_view name) {
  if (const int readings = count_readings(cloud); readings < kMinReadings)
    return failure(ErrorCode::kTooFewPoints, fmt::format("{}: finite points = {} of {} x {}, expected at least {} to find the camera", name,
                                                         readings, cloud.width, cloud.height, kMinReadings));
  const Candidate best = best_candidate(cloud, axes);
  if (best.readings < kMinReadings || !(best.rms_px() <= kMaxPinholeRms_px))
    return failure(ErrorCode::kUnsupported,
                   fmt::format("{}: not the grid of a pinhole camera{}: points miss their pixels by {:.3g} px rms, expected at most {}", name,
                               axes ? " with axes " + to_string(*axes) : "", best.rms_px(), kMaxPinholeRms_px));
  PinholeFit fit{{cloud.width, cloud.height, std::abs(best.right.focal_px()), std::abs(best.down.focal_px()),
                  best.right.centre_px() + 0.5 * cloud.width, best.down.centre_px() + 0.5 * cloud.height, DistortionModel::kNone, {}},
                 best.axes, best.rms_px(), best.readings};
  if (const Result<void> valid = validate(fit.camera); !valid)
    return failure(ErrorCode::kUnsupported, fmt::format("{}: fitted {}", name, valid.error().what));
  return fit;
}

}  // namespace gfp
