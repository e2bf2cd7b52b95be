#pragma once

#include <cstdint>
#include <vector>

#include "gfp/core/random.hpp"

namespace gfp {

/// A window into a large field of correlated normal noise (mean 0, variance 1), at a random place for each seed. The field is
/// made once a process and repeats every kSide pixels; it is the same everywhere.
class NoiseField {
 public:
  explicit NoiseField(Random& random);

  static constexpr int kSide = 1024;

  /// Noise of pixels (0, v) .. (count - 1, v).
  void copy_row(int v, int count, float* out) const;
  float at(int u, int v) const;

 private:
  int u0_, v0_;
};

}  // namespace gfp
