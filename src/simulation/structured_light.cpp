#include "simulation/structured_light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "simulation/noise_field.hpp"

// Row by row: which true pixel each measured pixel looks at (silhouettes waver), whether the projector reaches it, and then
// one vectorised pass over the row that turns depth into a noisy, quantised reading.

namespace gfp {
namespace {

constexpr int kMaxJitter_px = 3;
constexpr double kNearestReading_m = 0.1;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What measure_row() needs, in single precision.
struct RowModel {
  float base_m, quadratic_per_m, reference_m;  // SensorNoise, scaled
  float grazing_scale;                         // of the noise at slanted surfaces
  float focal_baseline;                        // f B, pixels * metres
  float disparity_step;                        // pixels
  float inverse_step;
  float cos_limit;                             // smaller: no reading
  float units_per_m;
  float fx, cx, ray_y2;                        // of the row: 1/f, principal point, ((v - cy) / fy)^2
};

/// readings[u] = 0 where depth is infinite, hidden or grazing. `plane` is the distance of each pixel's surface plane from the camera.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void measure_row(int width, const RowModel& model, const float* depth,
                                                                            const float* plane, const float* noise,
                                                                            const float* dropout, std::uint16_t* readings) {
  const RowModel m = model;
  for (int u = 0; u < width; ++u) {  // everything is computed for every pixel and chosen at the end: so it is vectorised
    const float depth_u = depth[u];
    const float z = depth_u < 100.0F ? depth_u : 1.0F;
    const float ray_x = (static_cast<float>(u) - m.cx) * m.fx;
    const float cosine = plane[u] / (z * std::sqrt(1.0F + ray_x * ray_x + m.ray_y2));
    const float c = std::max(cosine, 0.05F);
    // pi/2 - theta = asin(c); Nguyen's lateral term theta^2 / (pi/2 - theta)^2 matters from 60 degrees on.
    const float rest = c * (1.0F + c * c * (1.0F / 6.0F + c * c * 0.075F));
    const float slant = (1.5707963F - rest) / rest;
    const float slant_sigma = m.grazing_scale * slant * slant / std::sqrt(z);
    const float excess = std::max(z - m.reference_m, 0.0F);
    const float sigma = m.base_m + m.quadratic_per_m * excess * excess + (c < 0.5F ? slant_sigma : 0.0F);
    // The sensor's stated noise includes its disparity steps, so their variance is taken off before they are applied.
    const float step_m = z * z / m.focal_baseline * m.disparity_step;
    const float variance = sigma * sigma - step_m * step_m * (1.0F / 12.0F);
    const float noisy = std::max(z + std::sqrt(std::max(variance, 0.0F)) * noise[u], static_cast<float>(kNearestReading_m));
    const float steps = static_cast<float>(static_cast<int>(m.focal_baseline / noisy * m.inverse_step + 0.5F));
    const float units = m.focal_baseline / (steps * m.disparity_step) * m.units_per_m + 0.5F;
    const float limit = m.cos_limit + 0.05F * std::fabs(dropout[u]);
    const int whole = static_cast<int>(std::min(units, 65535.0F));
    const int read = static_cast<int>(depth_u < 100.0F) & static_cast<int>(cosine > limit) & static_cast<int>(units < 65535.0F);
    readings[u] = static_cast<std::uint16_t>(whole & -read);
  }
}

/// Disparity of each pixel (0 where nothing is hit) and the projector's column that lights it.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void project_row(int width, float focal_baseline, float shift, const float* depth,
                                                                            float* disparity, std::int32_t* column) {
  for (int u = 0; u < width; ++u) {
    disparity[u] = std::min(focal_baseline / depth[u], shift);
    column[u] = static_cast<std::int32_t>(static_cast<float>(u) + shift - disparity[u]);
  }
}

/// 1 where depth jumps to the right or downwards by more than a surface would.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void mark_jumps(int width, const float* depth, const float* below, std::uint8_t* jump) {
  for (int u = 0; u + 1 < width; ++u) {
    const float z = depth[u], tolerance = 0.012F + 0.012F * z;
    const float right = depth[u + 1] - z, down = below[u] - z;
    const int jumps = (right > tolerance) | (right < -tolerance) | (down > tolerance) | (down < -tolerance);
    jump[u] = static_cast<std::uint8_t>(jumps);
  }
  jump[width - 1] = 0;
}

class StructuredLight {
 public:
  StructuredLight(const Rendering& rendering, const CameraModel& camera, const VirtualCameraOptions& options, double scale_m, std::uint64_t seed)
      : tile_(rendering.tile), camera_(camera), options_(options), scale_m_(scale_m), random_(seed) {
    plane_distances_.reserve(rendering.facets.size() + 1);
    plane_distances_.push_back(0.0F);
    for (const Facet& facet : rendering.facets) plane_distances_.push_back(facet.plane_distance_m);
  }

  Image<std::uint16_t> measure() {
    Image<std::uint16_t> out(tile_.width, tile_.height);
    const auto width = static_cast<std::size_t>(tile_.width);
    for (auto* buffer : {&depth_, &plane_, &noise_, &dropout_, &disparity_}) buffer->resize(width);
    column_.resize(width);
    prepare_projector();
    find_silhouettes();
    hidden_.resize(width * static_cast<std::size_t>(tile_.height));
    for (int v = 0; v < tile_.height; ++v) cast_shadow(v);
    for (int v = 0; v < tile_.height; ++v) {
      gather(v);
      depth_noise_.copy_row(v, tile_.width, noise_.data());
      dropout_noise_.copy_row(v, tile_.width, dropout_.data());
      measure_row(tile_.width, row_model(v), depth_.data(), plane_.data(), noise_.data(), dropout_.data(),
                  out.pixels.data() + static_cast<std::size_t>(v) * width);
    }
    return out;
  }

 private:
  const float* row(int v) const { return tile_.depth.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(tile_.width); }

  RowModel row_model(int v) const {
    const auto f = [](double value) { return static_cast<float>(value); };
    const double ray_y = (v - camera_.cy) / camera_.fy, s = options_.noise_scale;
    // Without a baseline there are no steps: then they are as fine as single precision resolves at the nearest depth.
    const double disparity_of_1m = options_.shadow_baseline_m > 0 ? focal_baseline() : camera_.fx;
    const double wanted = options_.shadow_baseline_m > 0 ? options_.disparity_step_px * std::min(1.0, s) : 0.0;
    const double step = std::max(disparity_of_1m / kNearestReading_m / (1 << 24), wanted);
    return {f(s * options_.noise.base_m), f(s * options_.noise.quadratic_per_m), f(options_.noise.reference_m), f(s * 0.0001),
            f(disparity_of_1m), f(step), f(1 / step), f(std::cos(options_.grazing_dropout_deg * std::numbers::pi / 180)),
            f(1 / scale_m_), f(1 / camera_.fx), f(camera_.cx), f(ray_y * ray_y)};
  }

  double focal_baseline() const { return camera_.fx * options_.shadow_baseline_m; }

  void prepare_projector() {
    constexpr double kNearest_m = 0.25;
    shift_ = static_cast<int>(std::ceil(focal_baseline() / kNearest_m));
    lit_.resize(static_cast<std::size_t>(tile_.width + shift_ + 3));
  }

  /// The projector sees pixel u of depth z in its column u - f B / z; only the nearest surface of a column is lit.
  void cast_shadow(int v) {
    std::uint8_t* hidden = hidden_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(tile_.width);
    if (options_.shadow_baseline_m <= 0) {
      std::fill(hidden, hidden + tile_.width, std::uint8_t{0});
      return;
    }
    project_row(tile_.width, static_cast<float>(focal_baseline()), static_cast<float>(shift_), row(v), disparity_.data(), column_.data());
    std::fill(lit_.begin(), lit_.end(), 0.0F);
    for (std::size_t u = 0; u < disparity_.size(); ++u) {
      float* lit = lit_.data() + column_[u];
      lit[0] = std::max(lit[0], disparity_[u]);
      lit[1] = std::max(lit[1], disparity_[u]);  // what recedes leaves columns out
    }
    constexpr float kTolerance_px = 0.9F;
    for (std::size_t u = 0; u < disparity_.size(); ++u)
      hidden[u] = lit_[static_cast<std::size_t>(column_[u])] > disparity_[u] + kTolerance_px ? 1 : 0;
  }

  /// Pixels within two columns and rows of a jump in depth.
  void find_silhouettes() {
    const auto width = static_cast<std::size_t>(tile_.width);
    const auto height = static_cast<std::size_t>(tile_.height);
    std::vector<std::uint8_t> jumps(width * height, 0);
    for (std::size_t v = 0; v < height; ++v)
      mark_jumps(tile_.width, row(static_cast<int>(v)), row(static_cast<int>(std::min(v + 1, height - 1))), jumps.data() + v * width);
    silhouettes_.assign(height, {});
    for (std::size_t v = 0; v < height; ++v) {
      const auto begin = jumps.begin() + static_cast<std::ptrdiff_t>(v * width), end = begin + static_cast<std::ptrdiff_t>(width);
      for (auto jump = std::find(begin, end, std::uint8_t{1}); jump != end; jump = std::find(jump + 1, end, std::uint8_t{1}))
        mark_around(static_cast<int>(jump - begin), static_cast<int>(v));
    }
  }

  void mark_around(int u, int v) {
    constexpr int kReach = 2;
    const int first = std::max(u - kReach + 1, 0), last = std::min(u + kReach, tile_.width - 1);
    for (int j = std::max(v - kReach + 1, 0); j <= std::min(v + kReach, tile_.height - 1); ++j) {
      auto& runs = silhouettes_[static_cast<std::size_t>(j)];
      const bool goes_on = !runs.empty() && first >= runs.back().first && first <= runs.back().second + 1;
      if (goes_on) runs.back().second = std::max(runs.back().second, last);
      else runs.emplace_back(first, last);
    }
  }

  /// The row's true depth and plane as the wavering sensor sees them.
  void gather(int v) {
    const std::size_t start = static_cast<std::size_t>(v) * static_cast<std::size_t>(tile_.width);
    for (int u = 0; u < tile_.width; ++u) look(u, start + static_cast<std::size_t>(u));
    const auto amplitude = static_cast<float>(options_.edge_jitter_px * options_.noise_scale);
    if (amplitude <= 0) return;
    for (const auto& [first, last] : silhouettes_[static_cast<std::size_t>(v)])
      for (int u = first; u <= last; ++u) {
        const auto offset = [&](const NoiseField& field) {
          return static_cast<int>(std::lround(std::clamp(amplitude * field.at(u, v), -1.0F * kMaxJitter_px, 1.0F * kMaxJitter_px)));
        };
        const int from_u = std::clamp(u + offset(jitter_u_), 0, tile_.width - 1), from_v = std::clamp(v + offset(jitter_v_), 0, tile_.height - 1);
        look(u, static_cast<std::size_t>(from_v) * static_cast<std::size_t>(tile_.width) + static_cast<std::size_t>(from_u));
      }
  }

  /// Pixel u of the current row shows what is truly at `from`.
  void look(int u, std::size_t from) {
    const std::int32_t facet = tile_.triangle[from];
    depth_[static_cast<std::size_t>(u)] = hidden_[from] != 0 ? kInfinity : tile_.depth[from];
    plane_[static_cast<std::size_t>(u)] = plane_distances_[static_cast<std::size_t>(facet + 1)];
  }

  const DepthTile& tile_;
  const CameraModel& camera_;
  const VirtualCameraOptions& options_;
  const double scale_m_;
  Random random_;
  NoiseField depth_noise_{random_}, dropout_noise_{random_}, jitter_u_{random_}, jitter_v_{random_};
  int shift_ = 0;                                             // of the projector's columns, so that none is negative
  std::vector<float> lit_;                                    // per projector column: largest disparity
  std::vector<std::uint8_t> hidden_;                          // per pixel: in the projector's shadow
  std::vector<std::vector<std::pair<int, int>>> silhouettes_; // per row: runs of columns, both ends included
  std::vector<float> plane_distances_;                        // per facet, after one for "nothing"
  std::vector<float> depth_, plane_, noise_, dropout_, disparity_;  // of the row at hand
  std::vector<std::int32_t> column_;                          // of the projector, for the row at hand
};

}  // namespace

Image<std::uint16_t> measure_depth(const Rendering& rendering, const CameraModel& camera, const VirtualCameraOptions& options,
                                   double scale_m, std::uint64_t seed) {
  return StructuredLight(rendering, camera, options, scale_m, seed).measure();
}

Image<std::uint16_t> ideal_depth(const Rendering& rendering, double scale_m) {
  Image<std::uint16_t> out(rendering.tile.width, rendering.tile.height);
  const auto units_per_m = static_cast<float>(1 / scale_m);
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    const float units = rendering.tile.depth[i] * units_per_m + 0.5F;
    if (rendering.tile.triangle[i] >= 0 && units < 65535.0F) out.pixels[i] = static_cast<std::uint16_t>(units);
  }
  return out;
}

}  // namespace gfp
