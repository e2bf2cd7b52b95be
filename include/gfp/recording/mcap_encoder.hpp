#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/recording/mcap_records.hpp"

namespace gfp {

/// A closed chunk: a Chunk record with the MessageIndex records behind it. It carries its own schemas and channels, so it can be
/// read whatever becomes of the rest of the file.
struct McapChunk {
  std::string bytes;
  McapChunkInfo info;  ///< Offsets count from the beginning of `bytes`.
  std::map<std::uint16_t, std::uint64_t> message_counts;  ///< By channel.
};

struct McapEncoderOptions {
  std::size_t chunk_bytes = 1U << 20;            ///< A chunk that holds as much is closed.
  std::uint64_t chunk_span_ns = 200'000'000;     ///< So is one whose messages span more log time.
  int zstd_level = 1;                            ///< 0: no compression.
};

/// A channel before it has a number.
struct McapChannelSpec {
  std::string topic, message_encoding;
  std::string schema_name, schema_encoding, schema_data;
  std::map<std::string, std::string> metadata;
};

/// Turns messages into chunks. Knows no file and no clock: the same messages give the same bytes. One thread at a time.
class McapEncoder {
 public:
  explicit McapEncoder(const McapEncoderOptions& options = {});
  ~McapEncoder();
  McapEncoder(McapEncoder&&) noexcept;

  /// The channel of this description; the same again for an equal one. At most 65,535 are possible.
  Result<std::uint16_t> add_channel(const McapChannelSpec& spec);
  const McapRegistry& registry() const { return registry_; }
  /// Takes over the channels of another file with their numbers. Only before the first channel was added.
  void adopt(McapRegistry registry);

  /// Takes in one message of a channel of ours; gives the chunk that became full by it. Errors: kInvalidArgument (no such channel),
  /// kIo (out of memory; what the chunk held is lost).
  Result<std::optional<McapChunk>> add(const McapMessage& message);
  /// What is held back so far as a chunk; empty where there is nothing. Errors: kIo, as add().
  Result<std::optional<McapChunk>> flush();

  std::size_t waiting_messages() const { return waiting_; }

 private:
  struct Chunk;
  Result<std::optional<McapChunk>> close();
  void put_definitions(std::uint16_t channel);

  McapEncoderOptions options_;
  McapRegistry registry_;
  std::unique_ptr<Chunk> chunk_;
  std::size_t waiting_ = 0;
};

}  // namespace gfp
