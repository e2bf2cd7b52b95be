// A pixel's path costs are bytes, disparity by disparity: with 24 census bits and penalties up to 27 the sum of five paths fits a byte too.
// Every path is kept with its minimum taken off, which changes no decision: min_k L(k) is the same for all disparities of a pixel.
//
//   from left to right: cost, path from the left, three paths from above, their sum
//   from right to left: path from the right, then the smallest sums of the pixel and of the right picture's pixels that it meets
//
// This file is compiled for any CPU, and once more by stereo_kernels_avx2.cpp. Only bytes and whole numbers: both give the same. No inline function of
// others is called, since the linker might keep the one for AVX2.
#include "cloud/stereo_kernels.hpp"

#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace gfp {
namespace {

// GCC's vectors: 32 lanes are one AVX2 register, or two of SSE2.
using Bytes = std::uint8_t __attribute__((vector_size(32), aligned(1), may_alias));
using Words = std::uint16_t __attribute__((vector_size(32), aligned(1), may_alias));
using Half = std::uint8_t __attribute__((vector_size(16), aligned(1), may_alias));
using HalfWords = std::uint16_t __attribute__((vector_size(16), aligned(1), may_alias));
using HalfLanes = std::uint64_t __attribute__((vector_size(16), aligned(1), may_alias));
constexpr int kLanes = 32;

#define GFP_INLINE inline __attribute__((always_inline))

GFP_INLINE void load(const std::uint8_t* from, Bytes& to) { to = *reinterpret_cast<const Bytes*>(from); }
GFP_INLINE void store(std::uint8_t* to, const Bytes& value) { *reinterpret_cast<Bytes*>(to) = value; }
GFP_INLINE void take_min(Bytes& a, const Bytes& b) { a = b < a ? b : a; }

/// The smallest byte, in every byte. Half by half in registers: what goes through memory in two pieces stalls when it is read as one.
GFP_INLINE void spread_smallest(const Bytes& bytes, Bytes& everywhere) {
  Half low = __builtin_shufflevector(bytes, bytes, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const Half high = __builtin_shufflevector(bytes, bytes, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
  low = high < low ? high : low;
#ifdef __AVX2__
  const Half odd = reinterpret_cast<Half>(reinterpret_cast<HalfWords>(low) >> 8);
  low = odd < low ? odd : low;
  low = reinterpret_cast<Half>(_mm_minpos_epu16(reinterpret_cast<__m128i>(low)));
#else
  const Half swapped = reinterpret_cast<Half>(__builtin_shuffle(reinterpret_cast<HalfLanes>(low), HalfLanes{1, 0}));
  low = swapped < low ? swapped : low;
  for (int bits = 32; bits >= 8; bits /= 2) {  // only the lowest byte counts in the end
    const Half shifted = reinterpret_cast<Half>(reinterpret_cast<HalfLanes>(low) >> bits);
    low = shifted < low ? shifted : low;
  }
#endif
  everywhere = __builtin_shufflevector(low, low, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
}

/// Where the first of the bytes is that equal `value`, one of them; `index` is 0, 1, 2...
template <int kBlocks>
GFP_INLINE int first_of(const Bytes* bytes, const Bytes& value, [[maybe_unused]] const Bytes* index) {
#ifdef __AVX2__
  int first = 0;
  for (int b = kBlocks - 1; b >= 0; --b) {
    const auto equal = static_cast<unsigned>(_mm256_movemask_epi8(reinterpret_cast<__m256i>(bytes[b] == value)));
    first = equal != 0 ? kLanes * b + __builtin_ctz(equal) : first;
  }
  return first;
#else
  Bytes where = Bytes{} + 255, first;
  for (int b = 0; b < kBlocks; ++b) take_min(where, bytes[b] == value ? index[b] : Bytes{} + 255);
  spread_smallest(where, first);
  return first[0];
#endif
}

/// Pairs of bits of a byte counted into its two nibbles; the shift may run over bytes, the masks take that out again.
GFP_INLINE void count_nibbles(Bytes& bits) {
  bits -= reinterpret_cast<Bytes>(reinterpret_cast<Words>(bits) >> 1) & 0x55;
  bits = (bits & 0x33) + (reinterpret_cast<Bytes>(reinterpret_cast<Words>(bits) >> 2) & 0x33);
}

/// Differing census bits between one pixel and 32 of the other picture.
GFP_INLINE void hamming(const std::uint8_t* const* left, const std::uint8_t* const* right, int x, int at, Bytes& distance) {
  Bytes a, b, c;
  load(right[0] + at, a), load(right[1] + at, b), load(right[2] + at, c);
  a ^= left[0][x], b ^= left[1][x], c ^= left[2][x];
  const Bytes either = a ^ b;
  Bytes carry = (a & b) | (c & either), odd = either ^ c;  // a + b + c = odd + 2 carry, bit by bit
  count_nibbles(odd), count_nibbles(carry);
  const Bytes both = odd + carry + carry;
  distance = (both & 0x0F) + (reinterpret_cast<Bytes>(reinterpret_cast<Words>(both) >> 4) & 0x0F);
}

/// One byte up: `here` with the last of `before` in front.
GFP_INLINE void shift_up(const Bytes& before, const Bytes& here, Bytes& shifted) {
  shifted = __builtin_shufflevector(before, here, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62);
}

/// One byte down: `here` without its first, and the first of `after`.
GFP_INLINE void shift_down(const Bytes& here, const Bytes& after, Bytes& shifted) {
  shifted = __builtin_shufflevector(here, after, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32);
}

/// One step of one path: L(d) = cost(d) + min(before(d), before(d -+ 1) + small_step, jump), less its minimum. `down` and `up` are before(d -+ 1).
template <int kBlocks>
GFP_INLINE void step(const Bytes* before, const Bytes* down, const Bytes* up, const Bytes* cost, std::uint8_t small_step, std::uint8_t jump, Bytes* path) {
  Bytes least;
  for (int b = 0; b < kBlocks; ++b) {
    Bytes beside = down[b];
    take_min(beside, up[b]);
    beside += small_step;
    take_min(beside, Bytes{} + jump);
    take_min(beside, before[b]);
    path[b] = beside + cost[b];
    if (b == 0) least = path[b];
    else take_min(least, path[b]);
  }
  Bytes offset;
  spread_smallest(least, offset);
  for (int b = 0; b < kBlocks; ++b) path[b] -= offset;
}

/// A step along the row: the path stays in registers, since bytes that were just stored stall when they are read shifted.
template <int kBlocks>
GFP_INLINE void step_across(Bytes* path, const Bytes* cost, std::uint8_t small_step, std::uint8_t jump, Bytes* sum) {
  Bytes down[kBlocks], up[kBlocks];
  for (int b = 0; b < kBlocks; ++b) {
    shift_up(b > 0 ? path[b - 1] : Bytes{} + kGuardValue, path[b], down[b]);
    shift_down(path[b], b + 1 < kBlocks ? path[b + 1] : Bytes{} + kGuardValue, up[b]);
  }
  step<kBlocks>(path, down, up, cost, small_step, jump, path);
  for (int b = 0; b < kBlocks; ++b) sum[b] += path[b];
}

/// A step from a slot of the row above.
template <int kBlocks>
GFP_INLINE void step_down(const std::uint8_t* above, const Bytes* cost, std::uint8_t small_step, std::uint8_t jump, std::uint8_t* after, Bytes* sum) {
  Bytes before[kBlocks], down[kBlocks], up[kBlocks], path[kBlocks];
  for (int b = 0; b < kBlocks; ++b) load(above + kLanes * b, before[b]), load(above + kLanes * b - 1, down[b]), load(above + kLanes * b + 1, up[b]);
  step<kBlocks>(before, down, up, cost, small_step, jump, path);
  for (int b = 0; b < kBlocks; ++b) store(after + kLanes * b, path[b]), sum[b] += path[b];
}

template <int kBlocks>
void from_left(const StereoRow& given) {
  const StereoRow row = given;  // a local: the bytes that are stored below cannot change it
  constexpr int kSlot = kLanes * kBlocks + kPathGuard;
  Bytes across[kBlocks] = {};
  for (int x = 0; x < row.width; ++x) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(x) * kSlot;
    const int first = row.width - 1 - x;
    Bytes cost[kBlocks], sum[kBlocks] = {};
    for (int b = 0; b < kBlocks; ++b) {
      hamming(row.left, row.right, x, first + kLanes * b, cost[b]);
      store(row.cost + at + kLanes * b, cost[b]);
    }
    if (first + kLanes * kBlocks > row.first_invalid) {  // disparities that point out of the picture
      const int valid = row.first_invalid > first ? row.first_invalid - first : 0;
      std::memset(row.cost + at + valid, kCensusBits, static_cast<std::size_t>(kLanes * kBlocks - valid));
      for (int b = 0; b < kBlocks; ++b) load(row.cost + at + kLanes * b, cost[b]);
    }
    step_across<kBlocks>(across, cost, row.small_step, row.jump, sum);
    step_down<kBlocks>(row.up + at, cost, row.small_step, row.jump, row.up + at, sum);
    step_down<kBlocks>(row.up_left_before + at - kSlot, cost, row.small_step, row.jump, row.up_left + at, sum);
    step_down<kBlocks>(row.up_right + at + kSlot, cost, row.small_step, row.jump, row.up_right + at, sum);
    for (int b = 0; b < kBlocks; ++b) store(row.sum + at + kLanes * b, sum[b]);
  }
}

/// 0, 1, 2... in every block.
template <int kBlocks>
GFP_INLINE void count_up(Bytes* index) {
  for (int b = 0; b < kBlocks; ++b)
    for (int i = 0; i < kLanes; ++i) index[b][i] = static_cast<std::uint8_t>(kLanes * b + i);
}

/// 255 at kBeside and the bytes before and after, 0 elsewhere: read from kBeside - d it marks d and its neighbours.
constexpr int kBeside = 256;
struct BesideTable {
  alignas(kLanes) std::uint8_t bytes[2 * kBeside + kLanes] = {};
  constexpr BesideTable() {
    for (int i = kBeside - 1; i <= kBeside + 1; ++i) bytes[i] = 255;
  }
};
constexpr BesideTable kBesideTable;

/// The smallest sum of pixel x, where it is, the sums beside it, and the smallest of the others.
template <int kBlocks>
GFP_INLINE void find_minima(const StereoRow& row, int x, const Bytes* sum, const Bytes* index) {
  Bytes least = sum[0], best_sum;
  for (int b = 1; b < kBlocks; ++b) take_min(least, sum[b]);
  spread_smallest(least, best_sum);
  const int best = first_of<kBlocks>(sum, best_sum, index);

  Bytes others = Bytes{} + 255, second_sum;
  std::uint8_t sums[kLanes * (kBlocks + 2)];
  sums[kLanes - 1] = sums[kLanes * (kBlocks + 1)] = 255;
  for (int b = 0; b < kBlocks; ++b) {
    Bytes beside;
    load(kBesideTable.bytes + kBeside - best + kLanes * b, beside);
    take_min(others, sum[b] | beside);
    store(sums + kLanes * (b + 1), sum[b]);
  }
  spread_smallest(others, second_sum);
  row.best[x] = static_cast<std::uint8_t>(best);
  row.best_sum[x] = best_sum[0];
  row.second_sum[x] = second_sum[0];
  row.sum_before[x] = sums[kLanes + best - 1];
  row.sum_after[x] = sums[kLanes + best + 1];
}

/// The right picture's pixels that a left pixel can meet: their smallest sums so far. One leaves and one enters with each pixel.
template <int kBlocks>
struct Met {
  Bytes sum[kBlocks], best[kBlocks];
};

template <int kBlocks>
GFP_INLINE void meet(Met<kBlocks>& met, const Bytes* sum, const Bytes* index) {
  for (int b = 0; b < kBlocks; ++b) {
    met.best[b] = sum[b] < met.sum[b] ? index[b] : met.best[b];
    take_min(met.sum[b], sum[b]);
  }
}

template <int kBlocks>
GFP_INLINE void leave(Met<kBlocks>& met) {
  for (int b = 0; b < kBlocks; ++b) {
    shift_down(met.sum[b], b + 1 < kBlocks ? met.sum[b + 1] : Bytes{} + 255, met.sum[b]);
    shift_down(met.best[b], b + 1 < kBlocks ? met.best[b + 1] : Bytes{}, met.best[b]);
  }
}

template <int kBlocks>
void from_right(const StereoRow& given) {
  const StereoRow row = given;
  constexpr int kSlot = kLanes * kBlocks + kPathGuard;
  Bytes index[kBlocks], across[kBlocks] = {};
  count_up<kBlocks>(index);
  Met<kBlocks> met;
  for (int b = 0; b < kBlocks; ++b) met.sum[b] = Bytes{} + 255, met.best[b] = Bytes{};
  for (int x = row.width - 1; x >= 0; --x) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(x) * kSlot;
    Bytes cost[kBlocks], sum[kBlocks];
    for (int b = 0; b < kBlocks; ++b) load(row.cost + at + kLanes * b, cost[b]), load(row.sum + at + kLanes * b, sum[b]);
    step_across<kBlocks>(across, cost, row.small_step, row.jump, sum);
    find_minima<kBlocks>(row, x, sum, index);
    meet(met, sum, index);
    row.right_best[row.width - 1 - x] = met.best[0][0];
    leave(met);
  }
}

void census_row(const std::uint8_t* image, std::ptrdiff_t stride, int direction, int width, std::uint8_t* plane0, std::uint8_t* plane1, std::uint8_t* plane2) {
  static constexpr int kOffsets[kCensusBits][2] = {{-2, -2}, {-1, -2}, {0, -2}, {1, -2}, {2, -2}, {-2, -1}, {-1, -1}, {0, -1}, {1, -1}, {2, -1}, {-2, 0}, {-1, 0},
                                                   {1, 0}, {2, 0}, {-2, 1}, {-1, 1}, {0, 1}, {1, 1}, {2, 1}, {-2, 2}, {-1, 2}, {0, 2}, {1, 2}, {2, 2}};
  std::uint8_t* const planes[3] = {plane0, plane1, plane2};
  for (int p = 0; p < 3; ++p) {
    std::uint8_t* __restrict out = planes[p];
    const std::uint8_t* near[8];
    for (int k = 0; k < 8; ++k) near[k] = image + kOffsets[8 * p + k][1] * stride + direction * kOffsets[8 * p + k][0];
    for (int x = 0; x < width; ++x) {
      unsigned bits = 0;
      for (int k = 0; k < 8; ++k) bits |= static_cast<unsigned>(near[k][x] < image[x]) << k;
      out[x] = static_cast<std::uint8_t>(bits);
    }
  }
}

void aggregate_row(const StereoRow& row) {
  switch (row.disparities / kLanes) {
#define GFP_BLOCKS(n) case n: from_left<n>(row), from_right<n>(row); break;
    GFP_BLOCKS(1) GFP_BLOCKS(2) GFP_BLOCKS(3) GFP_BLOCKS(4) GFP_BLOCKS(6) GFP_BLOCKS(8)
#undef GFP_BLOCKS
    default: break;
  }
}

}  // namespace

#ifdef GFP_AVX2_STEREO_KERNELS
const StereoKernels kAvx2StereoKernels{census_row, aggregate_row};
#else
const StereoKernels kAnyStereoKernels{census_row, aggregate_row};

bool has_avx2_stereo_kernels() {
#ifdef __x86_64__
  return __builtin_cpu_supports("x86-64-v3") != 0;
#else
  return false;
#endif
}
#endif

}  // namespace gfp
