#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp::wire {

/// A payload as JSON, keys as in proto/gfp/v1, arrays of bytes as base64; for people and scripts. `schema` is the
/// Envelope's. Errors: kUnsupported (a message we do not know), kTooLarge, kCorruptData.
Result<nlohmann::ordered_json> payload_json(const std::string& schema, std::string_view payload);

/// The same as indented text, long arrays and texts cut short.
Result<std::string> payload_text(const std::string& schema, std::string_view payload);

}  // namespace gfp::wire
