#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/recording/mcap_encoder.hpp"

namespace gfp::mcap {

/// Log time and offset in the uncompressed chunk of every message, by channel.
using MessageTimes = std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>>;

/// A Chunk record and its MessageIndex records. `put_records` appends the (compressed) records.
Result<McapChunk> make_chunk(MessageTimes index, std::uint64_t uncompressed_bytes, std::uint32_t crc, const std::string& compression,
                             const std::function<Result<void>(std::string&)>& put_records);

}  // namespace gfp::mcap
