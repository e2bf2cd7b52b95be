#include "recording/mcap_layout.hpp"

#include <zlib.h>

#include "recording/little_endian.hpp"

namespace gfp::mcap {
namespace {

void put_map(BytePut& put, std::string& out, const std::map<std::string, std::string>& values) {
  const std::size_t length_at = out.size();
  put.number(std::uint32_t{0});
  for (const auto& [key, value] : values) {
    put.text(key);
    put.text(value);
  }
  put.number_at(length_at, static_cast<std::uint32_t>(out.size() - length_at - 4));
}

std::map<std::string, std::string> map_from(ByteGet& get) {
  ByteGet entries(get.text());
  std::map<std::string, std::string> values;
  while (entries.ok() && !entries.at_end()) {
    const std::string_view key = entries.text();
    values.emplace(key, entries.text());
  }
  return values;
}

}  // namespace

void put_header(std::string& out, std::string_view library) {
  put_record(out, Op::kHeader, [&] {
    BytePut put(out);
    put.text("");  // profile
    put.text(library);
  });
}

void put_schema(std::string& out, const McapSchema& schema) {
  put_record(out, Op::kSchema, [&] {
    BytePut put(out);
    put.number(schema.id);
    put.text(schema.name);
    put.text(schema.encoding);
    put.text(schema.data);
  });
}

void put_channel(std::string& out, const McapChannel& channel) {
  put_record(out, Op::kChannel, [&] {
    BytePut put(out);
    put.number(channel.id);
    put.number(channel.schema_id);
    put.text(channel.topic);
    put.text(channel.message_encoding);
    put_map(put, out, channel.metadata);
  });
}

void put_chunk_index(std::string& out, const McapChunkInfo& chunk) {
  put_record(out, Op::kChunkIndex, [&] {
    BytePut put(out);
    for (const std::uint64_t value : {chunk.start_ns, chunk.end_ns, chunk.offset, chunk.length}) put.number(value);
    put.number(static_cast<std::uint32_t>(chunk.index_offsets.size() * 10));
    for (const auto& [channel, offset] : chunk.index_offsets) {
      put.number(channel);
      put.number(offset);
    }
    put.number(chunk.index_length);
    put.text(chunk.compression);
    put.number(chunk.compressed_bytes);
    put.number(chunk.uncompressed_bytes);
  });
}

void put_metadata(std::string& out, std::string_view name, const std::map<std::string, std::string>& values) {
  put_record(out, Op::kMetadata, [&] {
    BytePut put(out);
    put.text(name);
    put_map(put, out, values);
  });
}

void put_summary_offset(std::string& out, Op group, std::uint64_t start, std::uint64_t length) {
  put_record(out, Op::kSummaryOffset, [&] {
    BytePut put(out);
    put.number(static_cast<std::uint8_t>(group));
    put.number(start);
    put.number(length);
  });
}

std::optional<McapSchema> schema_from(std::string_view content) {
  ByteGet get(content);
  McapSchema schema;
  schema.id = get.number<std::uint16_t>();
  schema.name = get.text();
  schema.encoding = get.text();
  schema.data = get.text();
  if (!get.ok() || schema.id == 0) return std::nullopt;
  return schema;
}

std::optional<McapChannel> channel_from(std::string_view content) {
  ByteGet get(content);
  McapChannel channel;
  channel.id = get.number<std::uint16_t>();
  channel.schema_id = get.number<std::uint16_t>();
  channel.topic = get.text();
  channel.message_encoding = get.text();
  channel.metadata = map_from(get);
  if (!get.ok()) return std::nullopt;
  return channel;
}

std::optional<std::pair<std::string, std::map<std::string, std::string>>> metadata_from(std::string_view content) {
  ByteGet get(content);
  std::string name(get.text());
  auto values = map_from(get);
  if (!get.ok() || get.left() != 0) return std::nullopt;
  return std::pair{std::move(name), std::move(values)};
}

std::optional<McapChunkInfo> chunk_index_from(std::string_view content) {
  ByteGet get(content);
  McapChunkInfo chunk;
  for (std::uint64_t* value : {&chunk.start_ns, &chunk.end_ns, &chunk.offset, &chunk.length}) *value = get.number<std::uint64_t>();
  ByteGet offsets(get.text());
  while (offsets.ok() && !offsets.at_end()) {
    const auto channel = offsets.number<std::uint16_t>();
    chunk.index_offsets[channel] = offsets.number<std::uint64_t>();
  }
  chunk.index_length = get.number<std::uint64_t>();
  chunk.compression = get.text();
  chunk.compressed_bytes = get.number<std::uint64_t>();
  chunk.uncompressed_bytes = get.number<std::uint64_t>();
  if (!get.ok() || !offsets.ok()) return std::nullopt;
  return chunk;
}

std::optional<ChunkContent> chunk_from(std::string_view content) {
  ByteGet get(content);
  ChunkContent chunk;
  chunk.start_ns = get.number<std::uint64_t>();
  chunk.end_ns = get.number<std::uint64_t>();
  chunk.uncompressed_bytes = get.number<std::uint64_t>();
  chunk.crc = get.number<std::uint32_t>();
  chunk.compression = get.text();
  chunk.records = get.take(get.number<std::uint64_t>());
  if (!get.ok()) return std::nullopt;
  return chunk;
}

std::optional<McapMessage> message_from(std::string_view content) {
  ByteGet get(content);
  McapMessage message;
  message.channel = get.number<std::uint16_t>();
  message.sequence = get.number<std::uint32_t>();
  message.log_time_ns = get.number<std::uint64_t>();
  message.publish_time_ns = get.number<std::uint64_t>();
  if (!get.ok()) return std::nullopt;
  message.data = get.rest();
  return message;
}

std::optional<Record> RecordWalk::next() {
  if (position_ == bytes_.size()) return std::nullopt;
  ByteGet get(bytes_.substr(position_));
  Record record;
  record.offset = position_;
  record.op = get.number<std::uint8_t>();
  record.content = get.take(get.number<std::uint64_t>());
  sound_ = sound_ && get.ok();
  if (!get.ok()) {
    position_ = bytes_.size();
    return std::nullopt;
  }
  position_ += kRecordHeaderBytes + record.content.size();
  return record;
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t so_far) {
  return static_cast<std::uint32_t>(crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace gfp::mcap
