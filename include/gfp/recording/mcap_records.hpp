#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gfp {

// What an MCAP file (mcap.dev/spec, version 0 of the format) says, as plain data. Times are nanoseconds of whatever clock the
// recorder used; ours is the host's CLOCK_REALTIME.

/// How the messages of channels are to be read. `data` of Protobuf is a FileDescriptorSet, of `ros2msg` the text of the definitions.
struct McapSchema {
  std::uint16_t id = 0;  ///< Not 0.
  std::string name, encoding, data;
  friend bool operator==(const McapSchema&, const McapSchema&) = default;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: none.
  std::string topic, message_encoding;
  std::map<std::string, std::string> metadata;
  friend bool operator==(const McapChannel&, const McapChannel&) = default;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::string_view data;  ///< Of whoever made the message.
};

/// Where a chunk lies in its file, as a ChunkIndex record says.
struct McapChunkInfo {
  std::uint64_t start_ns = 0, end_ns = 0;          ///< Log times of its messages.
  std::uint64_t offset = 0, length = 0;            ///< Of the whole record.
  std::map<std::uint16_t, std::uint64_t> index_offsets;  ///< Of the MessageIndex records, by channel.
  std::uint64_t index_length = 0;                  ///< Of all of them.
  std::string compression;                         ///< `zstd`, `lz4` or empty.
  std::uint64_t compressed_bytes = 0, uncompressed_bytes = 0;
};

/// Schemas and channels by id: one numbering for all chunks of a recording, so that a chunk can go into any of its files.
struct McapRegistry {
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
};

}  // namespace gfp
