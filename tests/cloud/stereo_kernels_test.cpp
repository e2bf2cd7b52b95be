#include "cloud/stereo_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// All that a kernel writes, over a few rows of one random pair.
struct Rows {
  Bytes census, path, found;
};

Rows run(const StereoKernels& kernels, int width, int disparities, int min_disparity) {
  constexpr int kRows = 4;
  Random random(7);
  const int stride = width + 2 * kCensusMargin, slot = disparities + kPathGuard;
  Bytes pictures[2] = {Bytes(static_cast<std::size_t>(stride * (kRows + 2 * kCensusMargin))), {}};
  for (auto& pixel : pictures[0]) pixel = static_cast<std::uint8_t>(random.below(40));  // few grey values: ties
  pictures[1] = pictures[0];
  for (std::size_t i = 0; i < pictures[1].size(); i += 3) pictures[1][i] = static_cast<std::uint8_t>(random.below(40));

  Bytes path(static_cast<std::size_t>(kPathGuard + (width + 2) * slot), 0);
  for (int end = kPathGuard; end <= kPathGuard + (width + 2) * slot; end += slot) std::fill_n(path.data() + end - kPathGuard, kPathGuard, kGuardValue);
  std::vector<Bytes> paths(6, path), census(6, Bytes(static_cast<std::size_t>(width + min_disparity + disparities)));
  std::vector<Bytes> found(6, Bytes(static_cast<std::size_t>(width)));
  const auto slots = [&](std::size_t i) { return paths[i].data() + kPathGuard + slot; };

  StereoRow row;
  row.width = width, row.disparities = disparities, row.small_step = 7, row.jump = 23, row.first_invalid = width - min_disparity;
  for (std::size_t p = 0; p < 3; ++p) row.left[p] = census[p].data(), row.right[p] = census[3 + p].data() + min_disparity;
  row.cost = slots(0), row.sum = slots(1), row.up = slots(2), row.up_right = slots(3);
  row.best = found[0].data(), row.best_sum = found[1].data(), row.second_sum = found[2].data();
  row.sum_before = found[3].data(), row.sum_after = found[4].data(), row.right_best = found[5].data();

  Rows all;
  for (int v = 0; v < kRows; ++v) {
    const std::ptrdiff_t at = (v + kCensusMargin) * stride + kCensusMargin;
    kernels.census_row(pictures[0].data() + at, stride, 1, width, census[0].data(), census[1].data(), census[2].data());
    kernels.census_row(pictures[1].data() + at, stride, -1, width, census[3].data(), census[4].data(), census[5].data());
    row.up_left_before = slots(4 + static_cast<std::size_t>(v % 2)), row.up_left = slots(5 - static_cast<std::size_t>(v % 2));
    kernels.aggregate_row(row);
    for (const Bytes& bytes : census) all.census.insert(all.census.end(), bytes.begin(), bytes.end());
    for (const Bytes& bytes : paths) all.path.insert(all.path.end(), bytes.begin(), bytes.end());
    for (const Bytes& bytes : found) all.found.insert(all.found.end(), bytes.begin(), bytes.end());
  }
  return all;
}

TEST(StereoKernels, GiveTheSameBytesOnEveryCpu) {
  if (!has_avx2_stereo_kernels()) GTEST_SKIP() << "this CPU has no AVX2: nothing to compare";
  for (const int disparities : {32, 64, 96, 128, 192, 256})
    for (const int min_disparity : {0, 5}) {
      SCOPED_TRACE(std::to_string(disparities) + " disparities from " + std::to_string(min_disparity));
      const Rows any = run(kAnyStereoKernels, 301, disparities, min_disparity), avx2 = run(kAvx2StereoKernels, 301, disparities, min_disparity);
      EXPECT_EQ(any.census, avx2.census);
      EXPECT_EQ(any.path, avx2.path);
      EXPECT_EQ(any.found, avx2.found);
      EXPECT_GT(*std::max_element(any.found.begin(), any.found.end()), 0);
    }
}

}  // namespace
}  // namespace gfp
