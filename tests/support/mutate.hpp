#pragma once

#include <algorithm>
#include <string>

#include "gfp/core/random.hpp"

namespace gfp::test {

/// Damages bytes as disks, cables and enemies do: flips, overwrites, cuts, repeats, and numbers turned hostile.
/// Most damage falls into the first `header` bytes, where it hurts most.
inline std::string mutated(std::string bytes, std::uint64_t seed, std::size_t header) {
  Random random(seed);
  const int changes = 1 + random.below(4);
  for (int i = 0; i < changes && !bytes.empty(); ++i) {
    const std::size_t span = random.below(3) > 0 ? std::min(header, bytes.size()) : bytes.size();
    const std::size_t at = static_cast<std::size_t>(random.next() % span);
    switch (random.below(6)) {
      case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8))); break;
      case 1: bytes[at] = static_cast<char>(random.below(256)); break;
      case 2: bytes.resize(at); break;
      case 3: bytes.insert(at, bytes.substr(at, static_cast<std::size_t>(1 + random.below(40)))); break;
      case 4: bytes.erase(at, static_cast<std::size_t>(1 + random.below(40))); break;
      default:
        for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k) bytes[k] = random.below(2) == 0 ? '\xff' : '9';
    }
  }
  return bytes;
}

}  // namespace gfp::test
