#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "gfp/memory/associate.hpp"

namespace gfp {
namespace {

// A structured-light sensor's noise is smooth over about 9 pixels: a patch is some sixteen readings.
constexpr int kPatch = 32, kBlock = 16;    ///< Pixels a side.
constexpr float kMostShift = 1.0F;         ///< Of a patch's mean depth, in standard deviations of one reading.
constexpr float kLeastForShift = 0.25F;    ///< Of a patch's pixels.
constexpr float kMostOneWay = 30.0F;       ///< Pixels of a block: noise jumps both ways along an edge, an edge that moves jumps one way.
constexpr float kMostReadings = 128.0F;    ///< Pixels of a block that have a reading now and had none, or the other way round.

/// What changed down the columns of a band of rows.
struct Columns {
  std::vector<float> shift_sigmas, calm, one_way, readings;

  explicit Columns(int width) : shift_sigmas(static_cast<std::size_t>(width)), calm(shift_sigmas), one_way(shift_sigmas), readings(shift_sigmas) {}
};

struct RowNoise {
  float now_scale_m, before_scale_m, base_m, quadratic_per_m, reference_m, jump_sigmas;
};

// Branch-free: every lane adds what concerns it.
__attribute__((target_clones("arch=x86-64-v3", "default"))) void add_row(int width, const std::uint16_t* __restrict now, const std::uint16_t* __restrict before,
                                                                         const RowNoise noise, float* __restrict shift_sigmas, float* __restrict calm,
                                                                         float* __restrict one_way, float* __restrict readings) {
  for (int u = 0; u < width; ++u) {
    const float a = static_cast<float>(now[u]) * noise.now_scale_m, b = static_cast<float>(before[u]) * noise.before_scale_m;
    const float beyond = b - noise.reference_m, excess = beyond > 0.0F ? beyond : 0.0F;
    const float sigmas = (a - b) / (noise.base_m + noise.quadratic_per_m * excess * excess);
    const float has_a = static_cast<float>(now[u] != 0), has_b = static_cast<float>(before[u] != 0), both = has_a * has_b;
    const float nearer = both * static_cast<float>(sigmas < -noise.jump_sigmas), farther = both * static_cast<float>(sigmas > noise.jump_sigmas);
    const float still = both - nearer - farther;
    calm[u] += still;
    shift_sigmas[u] += still * sigmas;
    one_way[u] += farther - nearer;
    readings[u] += has_a - has_b;
  }
}

float sum(const std::vector<float>& columns, int begin, int end) {
  float total = 0;
  for (int u = begin; u < end; ++u) total += columns[static_cast<std::size_t>(u)];
  return total;
}

bool shifted(const Columns& patch, int begin, int end) {
  const float calm = sum(patch.calm, begin, end);
  return calm >= kLeastForShift * kPatch * kPatch && std::abs(sum(patch.shift_sigmas, begin, end)) > kMostShift * calm;
}

bool jumped(const Columns& block, int begin, int end) {
  return std::abs(sum(block.one_way, begin, end)) > kMostOneWay || std::abs(sum(block.readings, begin, end)) > kMostReadings;
}

template <class Predicate>
bool any_span(int width, int step, Predicate&& holds) {
  for (int u = 0; u < width; u += step)
    if (holds(u, std::min(width, u + step))) return true;
  return false;
}

bool same_standpoint(const Frame& now, const Frame& before) {
  constexpr double kSameUp = 0.9994;  // cosine of 2 degrees: accelerometers are noisy
  const bool same_up = now.up_camera.has_value() == before.up_camera.has_value() && (!now.up_camera || now.up_camera->dot(*before.up_camera) > kSameUp);
  return same_up && now.sensor == before.sensor && now.camera == before.camera && same_pose(now.T_world_sensor, before.T_world_sensor);
}

}  // namespace

bool shows_the_same(const Frame& now, const Frame& before) {
  const int width = now.depth.pixels.width, height = now.depth.pixels.height;
  if (!same_standpoint(now, before) || width != before.depth.pixels.width || height != before.depth.pixels.height || now.mask.pixels != before.mask.pixels) return false;
  const RowNoise noise{static_cast<float>(now.depth.scale_m), static_cast<float>(before.depth.scale_m), static_cast<float>(now.noise.base_m),
                       static_cast<float>(now.noise.quadratic_per_m), static_cast<float>(now.noise.reference_m), 4 * std::numbers::sqrt2_v<float>};
  for (int patch_v = 0; patch_v < height; patch_v += kPatch) {
    Columns patch(width);
    for (int v = patch_v; v < std::min(height, patch_v + kPatch); ++v) {
      const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
      add_row(width, now.depth.pixels.pixels.data() + row, before.depth.pixels.pixels.data() + row, noise, patch.shift_sigmas.data(), patch.calm.data(),
              patch.one_way.data(), patch.readings.data());
      if ((v + 1) % kBlock != 0 && v + 1 != height) continue;
      if (any_span(width, kBlock, [&](int begin, int end) { return jumped(patch, begin, end); })) return false;
      for (auto* sums : {&patch.one_way, &patch.readings}) std::fill(sums->begin(), sums->end(), 0.0F);
    }
    if (any_span(width, kPatch, [&](int begin, int end) { return shifted(patch, begin, end); })) return false;
  }
  return true;
}

}  // namespace gfp
