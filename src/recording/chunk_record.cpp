#include "recording/chunk_record.hpp"

#include <algorithm>
#include <limits>

#include "recording/little_endian.hpp"
#include "recording/mcap_layout.hpp"

namespace gfp::mcap {
namespace {

void put_message_index(std::string& out, std::uint16_t channel, const std::vector<std::pair<std::uint64_t, std::uint64_t>>& messages) {
  put_record(out, Op::kMessageIndex, [&] {
    BytePut put(out);
    put.number(channel);
    put.number(static_cast<std::uint32_t>(messages.size() * 16));
    for (const auto& [time, offset] : messages) {
      put.number(time);
      put.number(offset);
    }
  });
}

}  // namespace

Result<McapChunk> make_chunk(MessageTimes index, std::uint64_t uncompressed_bytes, std::uint32_t crc, const std::string& compression,
                             const std::function<Result<void>(std::string&)>& put_records) {
  McapChunk chunk;
  McapChunkInfo& info = chunk.info;
  info.start_ns = index.empty() ? 0 : std::numeric_limits<std::uint64_t>::max();
  for (auto& [channel, messages] : index) {
    std::stable_sort(messages.begin(), messages.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    info.start_ns = std::min(info.start_ns, messages.front().first);
    info.end_ns = std::max(info.end_ns, messages.back().first);
  }
  info.uncompressed_bytes = uncompressed_bytes;
  info.compression = compression;
  std::string& out = chunk.bytes;
  BytePut put(out);
  Result<void> filled;
  put_record(out, Op::kChunk, [&] {
    for (const std::uint64_t value : {info.start_ns, info.end_ns, info.uncompressed_bytes}) put.number(value);
    put.number(crc);
    put.text(compression);
    const std::size_t length_at = out.size();
    put.number(std::uint64_t{0});
    filled = put_records(out);
    info.compressed_bytes = out.size() - length_at - 8;
    put.number_at(length_at, info.compressed_bytes);
  });
  if (!filled) return tl::unexpected(filled.error());
  info.length = out.size();
  for (const auto& [channel, messages] : index) {
    info.index_offsets[channel] = out.size();
    chunk.message_counts[channel] = messages.size();
    put_message_index(out, channel, messages);
  }
  info.index_length = out.size() - info.length;
  return chunk;
}

}  // namespace gfp::mcap
