#pragma once

#include <filesystem>
#include <string>

#include "gfp/core/error.hpp"

namespace gfp {

/// A key for CURVE, ZeroMQ's encryption and authentication (Curve25519), in Z85: 40 printable characters each.
struct CurveKey {
  std::string public_key;
  std::string secret_key;  ///< Empty where only the public half is known.
};

/// A new random key.
CurveKey new_curve_key();

/// Writes `<stem>.key` (both halves, readable by the owner only) and `<stem>.pub` (what others are given). Errors: kIo, also
/// where one of them exists already.
Result<void> write_curve_key(const std::filesystem::path& stem, const CurveKey& key);

/// Reads either. Errors: kNotFound, kTooLarge, kCorruptData (no line `public: <40 characters>`), kIo.
Result<CurveKey> read_curve_key(const std::filesystem::path& file);

}  // namespace gfp
