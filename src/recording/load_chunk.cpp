#include "recording/load_chunk.hpp"

#include <fmt/format.h>

#include "recording/compression.hpp"
#include "recording/little_endian.hpp"

namespace gfp::mcap {

Result<void> decompress_chunk(const ChunkContent& chunk, const McapReadOptions& options, std::string& records) {
  if (chunk.uncompressed_bytes > options.max_chunk_bytes)
    return failure(ErrorCode::kTooLarge, fmt::format("a chunk promises {} bytes, at most {} are read", chunk.uncompressed_bytes, options.max_chunk_bytes));
  if (auto done = decompress(chunk.compression, chunk.records, static_cast<std::size_t>(chunk.uncompressed_bytes), records); !done) return done;
  if (chunk.crc != 0 && crc32_of(records) != chunk.crc)
    return failure(ErrorCode::kCorruptData, fmt::format("a chunk's CRC is {:08x}, expected {:08x}", crc32_of(records), chunk.crc));
  return {};
}

Result<void> read_record(ByteSource& source, std::uint64_t offset, std::size_t max_bytes, std::string& record) {
  if (auto read = source.read_at(offset, kRecordHeaderBytes, record); !read) return read;
  ByteGet get(record);
  get.number<std::uint8_t>();
  const auto length = get.number<std::uint64_t>();
  if (!get.ok()) return failure(ErrorCode::kCorruptData, fmt::format("the file ends inside the record at byte {}", offset));
  if (length > max_bytes) return failure(ErrorCode::kTooLarge, fmt::format("a record of {} bytes, at most {} are read", length, max_bytes));
  const std::size_t size = kRecordHeaderBytes + static_cast<std::size_t>(length);
  if (auto read = source.read_at(offset, size, record); !read) return read;
  if (record.size() < size) return failure(ErrorCode::kCorruptData, fmt::format("the file ends inside the record at byte {}", offset));
  return {};
}

Result<void> visit_records(std::string_view records, const RecordVisitor& visit) {
  RecordWalk walk(records);
  while (const std::optional<Record> record = walk.next()) {
    const Op op = static_cast<Op>(record->op);
    bool sound = true;
    if (op == Op::kSchema) {
      auto schema = schema_from(record->content);
      sound = schema.has_value();
      if (sound && visit.schema) visit.schema(std::move(*schema));
    } else if (op == Op::kChannel) {
      auto channel = channel_from(record->content);
      sound = channel.has_value();
      if (sound && visit.channel) visit.channel(std::move(*channel));
    } else if (op == Op::kMessage) {
      const auto message = message_from(record->content);
      sound = message.has_value();
      if (sound && visit.message) visit.message(record->offset, *message);
    }
    if (!sound) return failure(ErrorCode::kCorruptData, fmt::format("the record at byte {} of a chunk is damaged", record->offset));
  }
  if (!walk.sound()) return failure(ErrorCode::kCorruptData, fmt::format("the last record of a chunk of {} bytes is cut", records.size()));
  return {};
}

}  // namespace gfp::mcap
