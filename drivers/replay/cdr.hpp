#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace gfp {

/// Reads plain CDR (XCDR1), as ROS 2 serialises messages: a header of 4 bytes that tells the byte order, then members aligned to
/// their size. What is not there reads as 0 or empty, and ok() is false from then on.
class CdrReader {
 public:
  explicit CdrReader(std::string_view bytes) {
    ok_ = bytes.size() >= 4 && bytes[0] == 0 && (bytes[1] == 0 || bytes[1] == 1);
    if (!ok_) return;
    swap_ = bytes[1] == 0;
    body_ = bytes.substr(4);
  }

  template <class Number>
  Number number() {
    position_ = (position_ + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number);
    const std::string_view raw = take(sizeof(Number));
    Number value{};
    if (raw.empty()) return value;
    char bytes[sizeof(Number)];
    std::copy(raw.begin(), raw.end(), bytes);
    if (swap_) std::reverse(bytes, bytes + sizeof(Number));
    std::memcpy(&value, bytes, sizeof(Number));
    return value;
  }

  /// Without its terminating zero.
  std::string_view text() {
    const std::string_view raw = take(number<std::uint32_t>());
    return raw.empty() ? raw : raw.substr(0, raw.size() - 1);
  }
  /// uint8[].
  std::string_view octets() { return take(number<std::uint32_t>()); }

  bool ok() const { return ok_; }
  bool is_big_endian() const { return swap_; }

 private:
  std::string_view take(std::uint64_t count) {
    if (!ok_ || position_ > body_.size() || count > body_.size() - position_) {
      ok_ = false;
      return {};
    }
    const std::string_view taken = body_.substr(position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::size_t>(count);
    return taken;
  }

  std::string_view body_;
  std::size_t position_ = 0;
  bool ok_ = false, swap_ = false;
};

}  // namespace gfp
