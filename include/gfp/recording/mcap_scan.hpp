#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "gfp/recording/byte_file.hpp"
#include "gfp/recording/mcap_records.hpp"

namespace gfp {

struct McapReadOptions {
  std::size_t max_chunk_bytes = 128U << 20;      ///< Larger chunks and loose messages are refused before anything is allocated.
  std::size_t max_definition_bytes = 16U << 20;  ///< The same for schemas, channels, metadata and the summary.
  std::size_t max_messages = 32'000'000;         ///< In one file.
};

/// Where a message lies.
struct McapMessageRef {
  static constexpr std::uint32_t kLoose = std::numeric_limits<std::uint32_t>::max();
  std::uint64_t log_time_ns = 0;
  std::uint64_t offset = 0;       ///< Of its record: in the uncompressed chunk; of a loose one in the file.
  std::uint32_t chunk = kLoose;   ///< Index into the reader's chunks.
  std::uint16_t channel = 0;
};

/// Bytes of a file that could not be used: [begin, end).
struct McapDamage {
  std::uint64_t begin = 0, end = 0;
  std::string why;
};

/// Pairs of a name and a value that somebody put into the file beside its messages.
struct McapMetadata {
  std::uint64_t offset = 0, length = 0;  ///< Of its record.
  std::string name;
  std::map<std::string, std::string> values;
};

/// What a walk through all bytes of a file found.
struct McapScan {
  struct Chunk {
    McapChunkInfo info;              ///< As the chunk's own content says.
    bool has_sound_index = false;    ///< A MessageIndex for every channel follows it, and nothing else.
  };
  McapRegistry registry;
  std::vector<Chunk> chunks;
  std::vector<McapMessageRef> messages;  ///< In file order.
  std::vector<McapMetadata> metadata;    ///< In file order.
  std::vector<McapDamage> damage;
  bool is_finished = false;              ///< The data section was closed; only then a summary can follow.
  std::uint64_t sound_end = 0;           ///< Behind the last whole record of the data section.
};

/// Walks through the whole data section and checks every chunk (length, compression, CRC, records), whatever is broken: after
/// damage it goes on with the next chunk that it finds. Summary and footer are not looked at.
/// Errors: kCorruptData (no MCAP file: neither its mark nor a chunk), kTooLarge (more messages than the options allow), kIo.
Result<McapScan> scan_mcap(ByteSource& source, const McapReadOptions& options = {});

}  // namespace gfp
