#pragma once

#include <functional>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/recording/mcap_scan.hpp"
#include "recording/mcap_layout.hpp"

namespace gfp::mcap {

/// Decompresses a chunk's records and checks their CRC. Errors: kTooLarge, kUnsupported, kCorruptData.
Result<void> decompress_chunk(const ChunkContent& chunk, const McapReadOptions& options, std::string& records);

/// Replaces `record` by the whole record at `offset` of the file. Errors: kTooLarge (above `max_bytes`), kCorruptData (cut), kIo.
Result<void> read_record(ByteSource& source, std::uint64_t offset, std::size_t max_bytes, std::string& record);

/// Checks that uncompressed records are whole and known, and calls back for each definition and message (its record's offset first).
struct RecordVisitor {
  std::function<void(McapSchema)> schema;
  std::function<void(McapChannel)> channel;
  std::function<void(std::uint64_t, const McapMessage&)> message;
};
/// Errors: kCorruptData.
Result<void> visit_records(std::string_view records, const RecordVisitor& visit);

}  // namespace gfp::mcap
