#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace gfp {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");

/// Appends numbers and texts as MCAP stores them: little-endian, a text after its length in 32 bits.
class BytePut {
 public:
  explicit BytePut(std::string& out) : out_(out) {}

  template <class Number>
  void number(Number value) {
    out_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    out_.append(text);
  }
  template <class Number>
  void number_at(std::size_t position, Number value) {
    std::memcpy(out_.data() + position, &value, sizeof value);
  }

 private:
  std::string& out_;
};

/// Reads the same, never beyond the end: what is not there reads as 0 or empty, and ok() is false from then on.
class ByteGet {
 public:
  explicit ByteGet(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  Number number() {
    Number value{};
    const std::string_view raw = take(sizeof value);
    if (!raw.empty()) std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return {};
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::string_view rest() { return take(bytes_.size()); }

  bool ok() const { return ok_; }
  bool at_end() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace gfp
