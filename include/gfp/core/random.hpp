#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace gfp {

/// A small seeded generator (SplitMix64) whose streams are the same on every platform and standard library.
/// One thread at a time.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }  ///< [0, count)
  double normal() {  // Box-Muller; one of the pair is enough
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  /// An independent stream for part `index` of the work: the result does not depend on the order of the parts.
  Random fork(std::uint64_t index) const { return Random(Random(state_ ^ (index * 0xD1342543DE82EF95ULL + 1)).next()); }

 private:
  std::uint64_t state_;
};

}  // namespace gfp
