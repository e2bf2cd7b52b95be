#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace gfp {

// Logarithm, exponential and angle without branches, tables or calls: compilers vectorise loops over them, and they give the same bits on every
// machine, which the C library's do not (it picks its code by processor). The first two are within 2 units in the last place.

/// Natural logarithm of a positive, normal number.
inline double fast_log(double x) {
  constexpr std::uint64_t kRootHalf = 0x3FE6A09E667F3BCD, kBias = 1023, kOneInMantissa = 0x4330000000000000;  // sqrt(1/2); 2^52
  // x = 2^exponent * m with m in [sqrt(1/2), sqrt(2))
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t biased = (bits - kRootHalf + (kBias << 52)) >> 52;
  const double exponent = std::bit_cast<double>(biased | kOneInMantissa) - 4503599627370496.0 - 1023.0;
  const double m = std::bit_cast<double>(bits - ((biased - kBias) << 52));
  // log m = 2 artanh(s) with s = (m - 1) / (m + 1), |s| < 0.172
  const double s = (m - 1) / (m + 1), w = s * s;
  const double series = w * (1.0 / 3 + w * (1.0 / 5 + w * (1.0 / 7 + w * (1.0 / 9 + w * (1.0 / 11 + w * (1.0 / 13 + w * (1.0 / 15 + w * (1.0 / 17 + w / 19))))))));
  return exponent * 0x1.62e42fefa3800p-1 + (exponent * 0x1.ef35793c76730p-45 + 2 * (s + s * series));  // ln 2 in two parts
}

/// e^x; x outside [-708, 709] counts as the bound.
inline double fast_exp(double x) {
  constexpr double kRound = 0x1.8p52;  // adding it leaves the nearest integer in the low bits
  const double inside = std::min(std::max(x, -708.0), 709.0);
  const double rounded = inside * 0x1.71547652b82fep0 + kRound, n = rounded - kRound;
  const double r = (inside - n * 0x1.62e42fefa3800p-1) - n * 0x1.ef35793c76730p-45;  // |r| < 0.347
  double sum = 1.0 / 479001600;
  sum = sum * r + 1.0 / 39916800;
  sum = sum * r + 1.0 / 3628800;
  sum = sum * r + 1.0 / 362880;
  sum = sum * r + 1.0 / 40320;
  sum = sum * r + 1.0 / 5040;
  sum = sum * r + 1.0 / 720;
  sum = sum * r + 1.0 / 120;
  sum = sum * r + 1.0 / 24;
  sum = sum * r + 1.0 / 6;
  sum = sum * r + 0.5;
  sum = sum * r + 1;
  sum = sum * r + 1;
  return sum * std::bit_cast<double>((std::bit_cast<std::uint64_t>(rounded) + 1023) << 52);
}

/// The angle in [0, pi] whose cosine and sine are as `cosine` and `sine` >= 0 to each other, to within 3e-8; 0 for (0, 0).
inline double fast_angle(double sine, double cosine) {
  constexpr double kQuarter = 0x1.921fb54442d18p-1, kHalf = 2 * kQuarter;  // of pi
  const double other = std::abs(cosine), small = std::min(sine, other), large = std::max(sine, other);
  // atan(small / large) = atan(s), s in [0, tan(pi / 8)], or pi / 4 + atan(s), s in [-tan(pi / 8), 0]
  const bool steep = small > 0.41421356237309503 * large;
  const double up = steep ? small - large : small, down = steep ? small + large : large;
  const double s = down > 0 ? up / down : 0.0, w = s * s;
  const double series = s - s * w * (1.0 / 3 - w * (1.0 / 5 - w * (1.0 / 7 - w * (1.0 / 9 - w * (1.0 / 11 - w * (1.0 / 13 - w / 15))))));
  const double acute = (steep ? kQuarter : 0.0) + series;
  const double upright = sine > other ? kHalf - acute : acute;
  return cosine < 0 ? 2 * kHalf - upright : upright;
}

}  // namespace gfp
