#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gfp/recording/mcap_records.hpp"

// The bytes of MCAP records: `u8 opcode, u64 length, content`. What the fields mean is in mcap_records.hpp.
namespace gfp::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordHeaderBytes = 9;
inline constexpr std::size_t kFooterBytes = kRecordHeaderBytes + 8 + 8 + 4;  ///< Without the magic behind it.
/// Of a Chunk record's content, up to its compression's name: start, end, uncompressed size, CRC.
inline constexpr std::size_t kChunkFixedBytes = 8 + 8 + 8 + 4;

enum class Op : std::uint8_t {
  kHeader = 0x01, kFooter, kSchema, kChannel, kMessage, kChunk, kMessageIndex, kChunkIndex, kAttachment, kAttachmentIndex,
  kStatistics, kMetadata, kMetadataIndex, kSummaryOffset, kDataEnd
};
inline constexpr std::uint8_t kFirstPrivateOp = 0x80;

/// Appends one record: what `fill` appends between begin and end is its content.
template <class Fill>
void put_record(std::string& out, Op op, Fill&& fill) {
  out.push_back(static_cast<char>(op));
  const std::size_t length_at = out.size();
  out.append(8, '\0');
  fill();
  const std::uint64_t length = out.size() - length_at - 8;
  out.replace(length_at, 8, reinterpret_cast<const char*>(&length), 8);
}

void put_header(std::string& out, std::string_view library);
void put_schema(std::string& out, const McapSchema& schema);
void put_channel(std::string& out, const McapChannel& channel);
void put_chunk_index(std::string& out, const McapChunkInfo& chunk);
void put_metadata(std::string& out, std::string_view name, const std::map<std::string, std::string>& values);
void put_summary_offset(std::string& out, Op group, std::uint64_t start, std::uint64_t length);

/// Contents of records; empty where they break the format.
std::optional<McapSchema> schema_from(std::string_view content);
std::optional<McapChannel> channel_from(std::string_view content);
std::optional<std::pair<std::string, std::map<std::string, std::string>>> metadata_from(std::string_view content);
std::optional<McapChunkInfo> chunk_index_from(std::string_view content);

struct ChunkContent {
  std::uint64_t start_ns = 0, end_ns = 0;
  std::uint64_t uncompressed_bytes = 0;
  std::uint32_t crc = 0;  ///< Of the uncompressed records; 0: not given.
  std::string_view compression, records;
};
std::optional<ChunkContent> chunk_from(std::string_view content);
std::optional<McapMessage> message_from(std::string_view content);

/// One record of a buffer.
struct Record {
  std::uint8_t op = 0;
  std::string_view content;
  std::size_t offset = 0;  ///< Of the record in the buffer.
};

/// Takes record after record out of a buffer.
class RecordWalk {
 public:
  explicit RecordWalk(std::string_view bytes) : bytes_(bytes) {}
  std::optional<Record> next();               ///< Empty at the end, and where the bytes stop being records.
  bool sound() const { return sound_; }       ///< So far all bytes were whole records.

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
  bool sound_ = true;
};

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t so_far = 0);

}  // namespace gfp::mcap
