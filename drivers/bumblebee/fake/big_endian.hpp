#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gfp {

/// Appends numbers as GVCP and GVSP have them.
class BigEndianWriter {
 public:
  explicit BigEndianWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  template <class Number>
  BigEndianWriter& operator<<(Number number) {
    for (std::size_t i = sizeof(Number); i-- > 0;) bytes_.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    return *this;
  }
  BigEndianWriter& operator<<(std::span<const std::uint8_t> data) {
    bytes_.insert(bytes_.end(), data.begin(), data.end());
    return *this;
  }

 private:
  std::vector<std::uint8_t>& bytes_;
};

inline std::uint16_t read16(const std::uint8_t* at) { return static_cast<std::uint16_t>(at[0] << 8 | at[1]); }
inline std::uint32_t read32(const std::uint8_t* at) { return static_cast<std::uint32_t>(read16(at)) << 16 | read16(at + 2); }

}  // namespace gfp
