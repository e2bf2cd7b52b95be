#pragma once

#include <fmt/format.h>
#include <google/protobuf/message_lite.h>
#include <google/protobuf/stubs/logging.h>

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp::wire {

/// Messages beyond these are refused before they are parsed: Protobuf's own limit is 2 GiB.
inline constexpr std::size_t kMaxEnvelopeBytes = 4096;
inline constexpr std::size_t kMaxSceneBytes = 64U << 20;
inline constexpr std::size_t kMaxTopologyBytes = 64U << 20;
inline constexpr std::size_t kMaxImageHeaderBytes = 16384;
inline constexpr std::size_t kMaxStatusBytes = 65536;

/// What a well-formed message may hold at most.
inline constexpr std::uint32_t kMaxVertices = 1U << 20;
inline constexpr int kMaxObjects = 4096;
inline constexpr int kMaxGrasps = 10'000;
inline constexpr int kMaxListItems = 65'536;

/// Errors: kTooLarge (more than `max_bytes`), kCorruptData (not a message of this type).
inline Result<void> parse_bounded(std::span<const std::byte> bytes, std::size_t max_bytes, google::protobuf::MessageLite& message) {
  if (bytes.size() > max_bytes)
    return failure(ErrorCode::kTooLarge, fmt::format("{} of {} bytes, at most {} are read", message.GetTypeName(), bytes.size(), max_bytes));
  const google::protobuf::LogSilencer quiet;  // the caller gets an Error; a library writes nothing to stderr
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return failure(ErrorCode::kCorruptData, fmt::format("{} of {} bytes does not parse", message.GetTypeName(), bytes.size()));
  return {};
}

inline std::span<const std::byte> as_bytes(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

}  // namespace gfp::wire
