#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gfp {

/// SHA-256 (FIPS 180-4) of what was put into it: content hashes that are the same on every machine.
class Sha256 {
 public:
  void put(std::span<const std::byte> bytes);
  /// Trivially copyable values in little-endian byte order, as they lie in memory.
  template <class T>
  void put_values(const std::vector<T>& values) {
    put_value(static_cast<std::uint64_t>(values.size()));
    put(std::as_bytes(std::span<const T>(values)));
  }
  template <class T>
  void put_value(const T& value) {
    put(std::as_bytes(std::span<const T, 1>(&value, 1)));
  }
  /// Ends the message.
  std::array<std::uint8_t, 32> digest();
  /// The first 8 bytes of the digest, big-endian: the number's hexadecimal form is the digest's beginning.
  std::uint64_t digest64();

 private:
  void compress(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t filled_ = 0;
  std::uint64_t length_ = 0;  ///< Bytes so far.
};

}  // namespace gfp
