#include "cloud/refine_disparity.hpp"

#include <array>
#include <vector>

namespace gfp {
namespace {

constexpr int kReach = 2;            // pixels to both sides
constexpr int kRows = 3;             // two above, this one, two below
constexpr float kNowhere = -1e6F;    // the disparity of a pixel without a match: near no other
constexpr float kMaxStep = 0.75F;    // the whole disparity is the census's to decide
constexpr float kMinTexture = 60.0F; // squared grey values: the sum of squared gradients of noise alone

/// What one row says, kReach entries of margin at both ends.
struct Row {
  std::vector<float> disparity, gradient, difference;
  explicit Row(int width) : disparity(static_cast<std::size_t>(width + 2 * kReach), kNowhere), gradient(disparity.size()), difference(disparity.size()) {}
};

/// Whole disparities, the mean gradient of both pictures, and left minus right at the matched pixel.
void fill(const std::uint8_t* left, const std::uint8_t* right, const std::uint16_t* disparity, int width, Row& row) {
  for (int u = 0; u < width; ++u) {
    const auto i = static_cast<std::size_t>(u + kReach);
    const int whole = (disparity[u] + kDisparityUnits / 2) / kDisparityUnits, met = u - whole;
    row.disparity[i] = kNowhere;
    if (disparity[u] == 0 || u < 1 || u + 1 >= width || met < 1 || met + 1 >= width) continue;
    row.disparity[i] = static_cast<float>(whole);
    row.gradient[i] = 0.25F * static_cast<float>(right[met + 1] - right[met - 1] + left[u + 1] - left[u - 1]);
    row.difference[i] = static_cast<float>(left[u] - right[met]);
  }
}

/// The step of every pixel in disparity, from the whole one; kNowhere where there is too little texture.
/// Around the whole disparity d: left - right = -gradient * step; a neighbour whose whole disparity is another is first moved to this one's.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void steps(const std::array<const float*, kRows>& disparity, const std::array<const float*, kRows>& gradient, const std::array<const float*, kRows>& difference, int width, float* __restrict step) {
  const float *const d[kRows] = {disparity[0], disparity[1], disparity[2]}, *const g[kRows] = {gradient[0], gradient[1], gradient[2]}, *const e[kRows] = {difference[0], difference[1], difference[2]};
  for (int u = 0; u < width; ++u) {
    const float here = d[1][u + kReach];
    float count = 0, sum_g = 0, sum_e = 0, sum_ge = 0, sum_gg = 0;
#pragma GCC unroll 3
    for (int r = 0; r < kRows; ++r)
#pragma GCC unroll 5
      for (int k = 0; k <= 2 * kReach; ++k) {
        const float apart = d[r][u + k] - here;
        const float is_same = (apart <= 1.0F) & (apart >= -1.0F) ? 1.0F : 0.0F;
        const float slope = is_same * g[r][u + k];
        const float moved = is_same * e[r][u + k] - slope * (is_same * apart);
        count += is_same;
        sum_g += slope;
        sum_e += moved;
        sum_ge += slope * moved;
        sum_gg += slope * slope;
      }
    const float per = 1.0F / count;
    const float texture = sum_gg - sum_g * sum_g * per, cross = sum_ge - sum_g * sum_e * per;
    step[u] = texture > kMinTexture ? -cross / texture : kNowhere;
  }
}

/// The disparities of one row moved by their steps, where these can be trusted.
__attribute__((target_clones("arch=x86-64-v3", "default")))
void refine(const float* whole, const float* step, int width, std::uint16_t* __restrict disparity) {
  for (int u = 0; u < width; ++u) {
    const bool trusted = (step[u] <= kMaxStep) & (step[u] >= -kMaxStep) & (whole[u] >= 0);
    const float units = (whole[u] + step[u]) * kDisparityUnits + 0.5F;
    disparity[u] = static_cast<std::uint16_t>(trusted ? static_cast<int>(units > 1 ? units : 1.0F) : disparity[u]);
  }
}

}  // namespace

void refine_disparity(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, DisparityImage& disparity) {
  const int width = left.width, height = left.height;
  std::array<Row, 2 * kReach + 1> ring{Row(width), Row(width), Row(width), Row(width), Row(width)};
  const Row nothing(width);
  const auto row_at = [&](int v) -> const Row& { return v < 0 || v >= height ? nothing : ring[static_cast<std::size_t>(v) % ring.size()]; };
  std::vector<float> step(static_cast<std::size_t>(width));
  const auto fill_row = [&](int v) {
    if (v < height) fill(&left.pixels[left.index(0, v)], &right.pixels[right.index(0, v)], &disparity.pixels.pixels[left.index(0, v)], width, ring[static_cast<std::size_t>(v) % ring.size()]);
  };
  for (int v = 0; v < kReach; ++v) fill_row(v);
  for (int v = 0; v < height; ++v) {
    fill_row(v + kReach);
    const Row &above = row_at(v - kReach), &here = row_at(v), &below = row_at(v + kReach);
    steps({above.disparity.data(), here.disparity.data(), below.disparity.data()}, {above.gradient.data(), here.gradient.data(), below.gradient.data()},
          {above.difference.data(), here.difference.data(), below.difference.data()}, width, step.data());
    std::uint16_t* const out = &disparity.pixels.pixels[left.index(0, v)];
    refine(here.disparity.data() + kReach, step.data(), width, out);
  }
}

}  // namespace gfp
