#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "gfp/core/error.hpp"

namespace gfp {

enum class PcdData { kAscii, kBinary, kBinaryCompressed };

struct PcdField {
  std::string name;
  int size = 4;      ///< Bytes of one value: 1, 2, 4 or 8.
  char type = 'F';   ///< I signed, U unsigned, F floating point.
  int count = 1;     ///< Values a point.
  std::size_t offset = 0;  ///< Bytes into a point's record.
};

/// The text that a PCD file begins with, checked: sides within kMaxImageSide, records within kMaxPcdRecordBytes, counts consistent.
struct PcdHeader {
  std::vector<PcdField> fields;
  int width = 0, height = 0;       ///< height 1: an unorganised cloud.
  std::size_t record_bytes = 0;    ///< Of one point.
  PcdData data = PcdData::kAscii;
  std::size_t data_offset = 0;     ///< First byte after the header.
  std::string viewpoint;           ///< As written; not applied (README of this driver).

  std::size_t points() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  /// nullptr where there is none.
  const PcdField* find(std::string_view name) const;
};

inline constexpr std::size_t kMaxPcdRecordBytes = 1024;
inline constexpr int kMaxUnorganisedPoints = 1 << 26;

/// `name` begins the messages. Errors: kCorruptData, kTooLarge; each names the quantity, its value and its bound.
Result<PcdHeader> parse_pcd_header(std::string_view bytes, std::string_view name);

}  // namespace gfp
