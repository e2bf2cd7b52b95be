#pragma once

#include <cmath>

namespace gfp {

/// The p-norm of (a, b), both >= 0, with its derivatives; p = 2/epsilon >= 1.
struct PNorm {
  double value = 0;
  double by_a = 0, by_b = 0;  ///< (a/value)^(p-1), (b/value)^(p-1): in [0, 1], never an overflow.
  double by_p = 0;            ///< Derivative by the exponent.
};

/// Everything comes from the ratio r = min/max <= 1: r^p underflows to 0 harmlessly, and log1p keeps what is small beside 1.
inline PNorm p_norm(double a, double b, double p) {
  const bool swapped = b > a;
  const double larger = swapped ? b : a, smaller = swapped ? a : b;
  if (!(larger > 0)) return {};
  const double ratio = smaller / larger;
  const double log_ratio = ratio > 0 ? std::log(ratio) : 0;
  const double power = ratio > 0 ? std::exp(p * log_ratio) : 0;
  const double log_sum = std::log1p(power);
  const double growth = std::exp(log_sum / p);  // value / larger
  PNorm norm;
  norm.value = larger * growth;
  const double by_larger = growth / (1 + power);
  const double by_smaller = ratio > 0 ? by_larger * power / ratio : (p > 1 ? 0 : 1);
  norm.by_a = swapped ? by_smaller : by_larger;
  norm.by_b = swapped ? by_larger : by_smaller;
  norm.by_p = norm.value / p * (power * log_ratio / (1 + power) - log_sum / p);
  return norm;
}

}  // namespace gfp
