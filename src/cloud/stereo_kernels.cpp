// A pixel's path costs are bytes, disparity by disparity: with 24 census bits and penalties up to 27 the sum of five paths fits a byte too.
// Every path is kept with its minimum taken off, which changes no decision: min_k L(k) is the same for all disparities of a pixel.
//
//   from left to right: cost, path from the left, three paths from above, their sum
//   from right to left: path from the right, then the smallest sums of the pixel and of the right picture's pixels that it meets
#include "cloud/stereo_kernels.hpp"

#include <algorithm>
#include <cstring>

namespace gfp {
namespace {

// GCC's vectors: 32 lanes are one AVX2 register, or two of SSE2.
using Bytes = std::uint8_t __attribute__((vector_size(32), aligned(1), may_alias));
using Words = std::uint16_t __attribute__((vector_size(32), aligned(1), may_alias));
using Half = std::uint8_t __attribute__((vector_size(16), aligned(1), may_alias));
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
  const Half swapped = reinterpret_cast<Half>(__builtin_shuffle(reinterpret_cast<HalfLanes>(low), HalfLanes{1, 0}));
  low = swapped < low ? swapped : low;
  for (const int bits : {32, 16, 8}) {  // only the lowest byte counts in the end
    const Half shifted = reinterpret_cast<Half>(reinterpret_cast<HalfLanes>(low) >> bits);
    low = shifted < low ? shifted : low;
  }
  everywhere = __builtin_shufflevector(low, low, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
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

/// One step of one path: L(d) = cost(d) + min(before(d), before(d -+ 1) + small_step, jump), less its minimum.
template <int kBlocks>
GFP_INLINE void step(const std::uint8_t* before, const Bytes* cost, std::uint8_t small_step, std::uint8_t jump, std::uint8_t* after, Bytes* sum) {
  Bytes path[kBlocks], least;
  for (int b = 0; b < kBlocks; ++b) {
    Bytes down, up;
    load(before + kLanes * b, path[b]), load(before + kLanes * b - 1, down), load(before + kLanes * b + 1, up);
    take_min(down, up);
    down += small_step;
    take_min(path[b], down);
    take_min(path[b], Bytes{} + jump);
    path[b] += cost[b];
    if (b == 0) least = path[b];
    else take_min(least, path[b]);
  }
  Bytes offset;
  spread_smallest(least, offset);
  for (int b = 0; b < kBlocks; ++b) {
    path[b] -= offset;
    store(after + kLanes * b, path[b]);
    sum[b] += path[b];
  }
}

template <int kBlocks>
GFP_INLINE void from_left(const StereoRow& given) {
  const StereoRow row = given;  // a local: the bytes that are stored below cannot change it
  constexpr int kSlot = kLanes * kBlocks + kPathGuard;
  std::uint8_t* const across = row.across;
  std::memset(across, 0, kLanes * kBlocks);
  for (int x = 0; x < row.width; ++x) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(x) * kSlot;
    const int first = row.width - 1 - x;
    Bytes cost[kBlocks], sum[kBlocks];
    for (int b = 0; b < kBlocks; ++b) {
      hamming(row.left, row.right, x, first + kLanes * b, cost[b]);
      store(row.cost + at + kLanes * b, cost[b]);
      sum[b] = Bytes{};
    }
    if (first + kLanes * kBlocks > row.first_invalid) {  // disparities that point out of the picture
      const int valid = std::max(0, row.first_invalid - first);
      std::memset(row.cost + at + valid, kCensusBits, static_cast<std::size_t>(kLanes * kBlocks - valid));
      for (int b = 0; b < kBlocks; ++b) load(row.cost + at + kLanes * b, cost[b]);
    }
    step<kBlocks>(across, cost, row.small_step, row.jump, across, sum);
    step<kBlocks>(row.up + at, cost, row.small_step, row.jump, row.up + at, sum);
    step<kBlocks>(row.up_left_before + at - kSlot, cost, row.small_step, row.jump, row.up_left + at, sum);
    step<kBlocks>(row.up_right + at + kSlot, cost, row.small_step, row.jump, row.up_right + at, sum);
    for (int b = 0; b < kBlocks; ++b) store(row.sum + at + kLanes * b, sum[b]);
  }
}

/// 0, 1, 2... in every block.
template <int kBlocks>
GFP_INLINE void count_up(Bytes* index) {
  for (int b = 0; b < kBlocks; ++b)
    for (int i = 0; i < kLanes; ++i) index[b][i] = static_cast<std::uint8_t>(kLanes * b + i);
}

template <int kBlocks>
GFP_INLINE void find_minima(const StereoRow& row, int x, const Bytes* sum, const Bytes* index) {
  Bytes least = sum[0];
  for (int b = 1; b < kBlocks; ++b) take_min(least, sum[b]);
  Bytes best_sum, best, second_sum;
  spread_smallest(least, best_sum);
  Bytes where = Bytes{} + 255;
  for (int b = 0; b < kBlocks; ++b) take_min(where, sum[b] == best_sum ? index[b] : Bytes{} + 255);
  spread_smallest(where, best);
  Bytes other = Bytes{} + 255;
  for (int b = 0; b < kBlocks; ++b) take_min(other, index[b] - best + 1 <= 2 ? Bytes{} + 255 : sum[b]);
  spread_smallest(other, second_sum);
  row.best[x] = best[0];
  row.best_sum[x] = best_sum[0];
  row.second_sum[x] = second_sum[0];
  for (int b = 0; b < kBlocks; ++b) {
    std::uint8_t* const met = row.right_sum + row.width - 1 - x + kLanes * b;
    std::uint8_t* const met_best = row.right_best + row.width - 1 - x + kLanes * b;
    Bytes right_sum, right_best;
    load(met, right_sum), load(met_best, right_best);
    store(met_best, sum[b] < right_sum ? index[b] : right_best);
    take_min(right_sum, sum[b]);
    store(met, right_sum);
  }
}

template <int kBlocks>
GFP_INLINE void from_right(const StereoRow& given) {
  const StereoRow row = given;
  constexpr int kSlot = kLanes * kBlocks + kPathGuard;
  Bytes index[kBlocks];
  count_up<kBlocks>(index);
  std::uint8_t* const across = row.across + kSlot;
  std::memset(across, 0, kLanes * kBlocks);
  std::memset(row.right_sum, 255, static_cast<std::size_t>(row.width + row.disparities));
  for (int x = row.width - 1; x >= 0; --x) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(x) * kSlot;
    Bytes cost[kBlocks], sum[kBlocks];
    for (int b = 0; b < kBlocks; ++b) load(row.cost + at + kLanes * b, cost[b]), load(row.sum + at + kLanes * b, sum[b]);
    step<kBlocks>(across, cost, row.small_step, row.jump, across, sum);
    for (int b = 0; b < kBlocks; ++b) store(row.sum + at + kLanes * b, sum[b]);
    find_minima<kBlocks>(row, x, sum, index);
  }
}

}  // namespace

__attribute__((target_clones("arch=x86-64-v3", "default")))
void census_row(const std::uint8_t* image, std::ptrdiff_t stride, int width, std::uint8_t* plane0, std::uint8_t* plane1, std::uint8_t* plane2) {
  static constexpr int kOffsets[kCensusBits][2] = {{-2, -2}, {-1, -2}, {0, -2}, {1, -2}, {2, -2}, {-2, -1}, {-1, -1}, {0, -1}, {1, -1}, {2, -1}, {-2, 0}, {-1, 0},
                                                   {1, 0}, {2, 0}, {-2, 1}, {-1, 1}, {0, 1}, {1, 1}, {2, 1}, {-2, 2}, {-1, 2}, {0, 2}, {1, 2}, {2, 2}};
  std::uint8_t* const planes[3] = {plane0, plane1, plane2};
  for (int p = 0; p < 3; ++p) {
    std::uint8_t* __restrict out = planes[p];
    const std::uint8_t* near[8];
    for (int k = 0; k < 8; ++k) near[k] = image + kOffsets[8 * p + k][1] * stride + kOffsets[8 * p + k][0];
    for (int x = 0; x < width; ++x) {
      unsigned bits = 0;
      for (int k = 0; k < 8; ++k) bits |= static_cast<unsigned>(near[k][x] < image[x]) << k;
      out[x] = static_cast<std::uint8_t>(bits);
    }
  }
}

__attribute__((target_clones("arch=x86-64-v3", "default")))
void aggregate_row(const StereoRow& row) {
  switch (row.disparities / kLanes) {
#define GFP_BLOCKS(n) case n: from_left<n>(row), from_right<n>(row); break;
    GFP_BLOCKS(1) GFP_BLOCKS(2) GFP_BLOCKS(3) GFP_BLOCKS(4) GFP_BLOCKS(6) GFP_BLOCKS(8)
#undef GFP_BLOCKS
    default: break;
  }
}

}  // namespace gfp
