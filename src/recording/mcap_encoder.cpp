#include "gfp/recording/mcap_encoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "recording/chunk_record.hpp"
#include "recording/compression.hpp"
#include "recording/little_endian.hpp"
#include "recording/mcap_layout.hpp"

namespace gfp {

/// The chunk at work.
struct McapEncoder::Chunk {
  ZstdCompressor compressor;
  std::string records;
  std::uint64_t start_ns = 0, end_ns = 0;
  mcap::MessageTimes index;
  std::set<std::uint16_t> schemas;  ///< Those that it defines already.

  explicit Chunk(int level) : compressor(level) {}
  void clear() {
    records.clear();
    index.clear();
    schemas.clear();
  }
};

McapEncoder::McapEncoder(const McapEncoderOptions& options) : options_(options), chunk_(std::make_unique<Chunk>(options.zstd_level)) {}
McapEncoder::~McapEncoder() = default;
McapEncoder::McapEncoder(McapEncoder&&) noexcept = default;

void McapEncoder::adopt(McapRegistry registry) { registry_ = std::move(registry); }

Result<std::uint16_t> McapEncoder::add_channel(const McapChannelSpec& spec) {
  std::uint16_t schema_id = 0;
  for (const auto& [id, schema] : registry_.schemas)
    if (schema.name == spec.schema_name && schema.encoding == spec.schema_encoding && schema.data == spec.schema_data) schema_id = id;
  const bool has_new_schema = schema_id == 0 && !spec.schema_name.empty();
  if (has_new_schema) schema_id = static_cast<std::uint16_t>(registry_.schemas.size() + 1);
  for (const auto& [id, channel] : registry_.channels)
    if (!has_new_schema && channel == McapChannel{id, schema_id, spec.topic, spec.message_encoding, spec.metadata}) return id;
  if (registry_.channels.size() >= std::numeric_limits<std::uint16_t>::max())
    return failure(ErrorCode::kTooLarge, fmt::format("channels = {}, no more are possible", registry_.channels.size()));
  if (has_new_schema) registry_.schemas[schema_id] = {schema_id, spec.schema_name, spec.schema_encoding, spec.schema_data};
  const auto id = static_cast<std::uint16_t>(registry_.channels.size() + 1);
  registry_.channels[id] = {id, schema_id, spec.topic, spec.message_encoding, spec.metadata};
  return id;
}

void McapEncoder::put_definitions(std::uint16_t id) {
  const McapChannel& channel = registry_.channels.at(id);
  if (channel.schema_id != 0 && chunk_->schemas.insert(channel.schema_id).second) mcap::put_schema(chunk_->records, registry_.schemas.at(channel.schema_id));
  mcap::put_channel(chunk_->records, channel);
}

Result<std::optional<McapChunk>> McapEncoder::add(const McapMessage& message) {
  if (!registry_.channels.contains(message.channel))
    return failure(ErrorCode::kInvalidArgument, fmt::format("channel = {}, expected one of the {} that were added", message.channel, registry_.channels.size()));
  Chunk& chunk = *chunk_;
  if (waiting_ == 0) chunk.start_ns = chunk.end_ns = message.log_time_ns;
  chunk.start_ns = std::min(chunk.start_ns, message.log_time_ns);
  chunk.end_ns = std::max(chunk.end_ns, message.log_time_ns);
  const auto [entry, is_new] = chunk.index.try_emplace(message.channel);
  if (is_new) put_definitions(message.channel);
  entry->second.emplace_back(message.log_time_ns, chunk.records.size());
  mcap::put_record(chunk.records, mcap::Op::kMessage, [&] {
    BytePut put(chunk.records);
    put.number(message.channel);
    put.number(message.sequence);
    put.number(message.log_time_ns);
    put.number(message.publish_time_ns);
    chunk.records.append(message.data);
  });
  ++waiting_;
  const bool full = chunk.records.size() >= options_.chunk_bytes || chunk.end_ns - chunk.start_ns >= options_.chunk_span_ns;
  return full ? close() : std::optional<McapChunk>();
}

Result<std::optional<McapChunk>> McapEncoder::flush() { return waiting_ > 0 ? close() : std::optional<McapChunk>(); }

Result<std::optional<McapChunk>> McapEncoder::close() {
  Chunk& chunk = *chunk_;
  waiting_ = 0;
  auto closed = mcap::make_chunk(std::move(chunk.index), chunk.records.size(), mcap::crc32_of(chunk.records), options_.zstd_level == 0 ? "" : "zstd",
                                 [&](std::string& out) -> Result<void> {
                                   if (options_.zstd_level > 0) return chunk.compressor.append(chunk.records, out);
                                   out.append(chunk.records);
                                   return {};
                                 });
  chunk.clear();
  if (!closed) return tl::unexpected(closed.error());
  return std::move(*closed);
}

}  // namespace gfp
