#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp::config {

/// A YAML file beyond these is refused while it is read, before a node of it exists.
inline constexpr std::size_t kMaxFileBytes = 256 * 1024;
inline constexpr int kMaxDepth = 24;
inline constexpr int kMaxNodes = 20'000;
inline constexpr int kMaxAliases = 64;

/// Parses one YAML document. `source` is what errors name (a file). Empty text is an empty document (Null node).
/// Errors: kTooLarge (a limit above), kCorruptData (not YAML, several documents, a key twice), each with source and line.
Result<YAML::Node> parse_yaml(std::string_view text, const std::string& source);

/// Reads a file of at most kMaxFileBytes. Errors: kNotFound, kIo, kTooLarge.
Result<std::string> read_text(const std::filesystem::path& file);

}  // namespace gfp::config
