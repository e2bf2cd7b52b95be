#pragma once

#include <cstddef>
#include <cstdint>

namespace gfp {

inline constexpr int kCensusBits = 24;
inline constexpr int kCensusMargin = 2;   ///< Pixels around an image that the census reads.
inline constexpr int kPathGuard = 32;     ///< Bytes behind every pixel's slot that stand for "no such disparity".
inline constexpr std::uint8_t kGuardValue = 200;
inline constexpr int kPaths = 5;

/// What the aggregation of one row reads and writes. A slot is `disparities` + kPathGuard bytes; slot -1 and slot `width` exist and stay 0.
struct StereoRow {
  int width = 0;
  int disparities = 0;                  ///< 32, 64, 96, 128, 192 or 256.
  std::uint8_t small_step = 0, jump = 0;
  const std::uint8_t* left[3] = {};     ///< Census of the left row.
  const std::uint8_t* right[3] = {};    ///< Census of the right row from its last pixel to its first, shifted so that [width - 1 - x + d] is what (x, d) meets.
  int first_invalid = 0;                ///< Entries of `right` from here on lie outside the picture.
  std::uint8_t* cost = nullptr;         ///< Slots; of this row.
  std::uint8_t* sum = nullptr;          ///< Slots; the first four paths' costs of this row, summed.
  std::uint8_t* up = nullptr;           ///< Slots; the path from above, of the row before and then of this one.
  std::uint8_t* up_right = nullptr;     ///< Likewise.
  const std::uint8_t* up_left_before = nullptr;
  std::uint8_t* up_left = nullptr;
  std::uint8_t* best = nullptr;         ///< Per pixel: the disparity of the smallest sum of the five paths...
  std::uint8_t* best_sum = nullptr;
  std::uint8_t* sum_before = nullptr;   ///< ...the sums of the disparities before and after it, 255 where there is none...
  std::uint8_t* sum_after = nullptr;
  std::uint8_t* second_sum = nullptr;   ///< ...and the smallest of the others.
  std::uint8_t* right_best = nullptr;   ///< The same for the right picture: its best disparities, indexed as `right`.
};

struct StereoKernels {
  /// One row of the census: three planes of eight comparisons with the centre each (5 x 5 pixels). `image` points to the row's first pixel in a picture with
  /// kCensusMargin replicated pixels around it; `direction` is -1 where that picture is mirrored, 1 otherwise.
  void (*census_row)(const std::uint8_t* image, std::ptrdiff_t stride, int direction, int width, std::uint8_t* plane0, std::uint8_t* plane1, std::uint8_t* plane2);

  /// Costs, five paths, and the minima of one row.
  void (*aggregate_row)(const StereoRow& row);
};

extern const StereoKernels kAnyStereoKernels;   ///< For any CPU...
extern const StereoKernels kAvx2StereoKernels;  ///< ...and for those of x86-64-v3, where has_avx2_stereo_kernels(). Both give the same bytes.
bool has_avx2_stereo_kernels();

}  // namespace gfp
