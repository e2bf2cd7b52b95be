#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gfp {

/// Disjoint sets of the numbers 0 to count - 1. The least member is its set's root: sets are then numbered in the order of their first
/// member, whatever the order in which they were joined.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count = 0) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// A new set with one member.
  std::int32_t add() {
    parent_.push_back(static_cast<std::int32_t>(parent_.size()));
    return parent_.back();
  }
  std::int32_t root(std::int32_t a) {
    while (parent_[static_cast<std::size_t>(a)] != a) {
      auto& up = parent_[static_cast<std::size_t>(a)];
      up = parent_[static_cast<std::size_t>(up)];
      a = up;
    }
    return a;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace gfp
