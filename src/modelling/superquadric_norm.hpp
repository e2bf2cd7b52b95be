#pragma once

#include <algorithm>
#include <cmath>

#include "gfp/core/elementary.hpp"

namespace gfp {

/// The p-norm of (a, b), both >= 0, with its derivatives; p = 2/epsilon >= 1.
struct PNorm {
  double value = 0;
  double by_a = 0, by_b = 0;  ///< (a/value)^(p-1), (b/value)^(p-1): in [0, 1], never an overflow.
  double by_p = 0;            ///< Derivative by the exponent.
};

/// Everything comes from the ratio r = min/max <= 1: r^p underflows harmlessly. Branch-free, so that loops over it vectorise; at the
/// origin, where the norm has no derivative, that of a point on the first axis stands in.
inline PNorm p_norm(double a, double b, double p) {
  constexpr double kTiny = 1e-290;
  const double larger = std::max(a, b), smaller = std::min(a, b);
  const double ratio = std::max(smaller / std::max(larger, kTiny), kTiny);
  const double log_ratio = fast_log(ratio);
  const double power = fast_exp(p * log_ratio);
  const double log_sum = fast_log(1 + power);
  const double growth = fast_exp(log_sum / p);  // value / larger
  const double by_larger = growth / (1 + power), by_smaller = std::min(1.0, by_larger * power / ratio);
  PNorm norm;
  norm.value = larger * growth;
  norm.by_a = b > a ? by_smaller : by_larger;
  norm.by_b = b > a ? by_larger : by_smaller;
  norm.by_p = norm.value / p * (power * log_ratio / (1 + power) - log_sum / p);
  return norm;
}

/// The p1-norm of (p2-norm of (x, y), z), signs and all: the gauge of a superquadric with half axes 1, and for the dual exponents its reach.
struct NestedNorm {
  double value = 0;
  double slope[3] = {};  ///< Derivative by x, y, z.
  double by_p1 = 0, by_p2 = 0;
};

inline __attribute__((always_inline)) NestedNorm nested_norm(double x, double y, double z, double p1, double p2) {
  const PNorm across = p_norm(std::abs(x), std::abs(y), p2);
  const PNorm whole = p_norm(across.value, std::abs(z), p1);
  return {whole.value,
          {std::copysign(whole.by_a * across.by_a, x), std::copysign(whole.by_a * across.by_b, y), std::copysign(whole.by_b, z)},
          whole.by_p,
          whole.by_a * across.by_p};
}

}  // namespace gfp
