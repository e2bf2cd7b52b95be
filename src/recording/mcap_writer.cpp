#include "gfp/recording/mcap_writer.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "gfp/core/version.hpp"
#include "recording/little_endian.hpp"
#include "recording/mcap_layout.hpp"

namespace gfp {

using mcap::Op;

Result<McapWriter> McapWriter::begin(std::unique_ptr<ByteFile> file) {
  McapWriter writer(std::move(file));
  std::string bytes(mcap::kMagic);
  mcap::put_header(bytes, "gfp " + std::string(version()));
  if (auto written = writer.write(bytes); !written) return tl::unexpected(written.error());
  return writer;
}

McapWriter McapWriter::resume(std::unique_ptr<ByteFile> file, std::uint64_t end, std::vector<McapChunkInfo> chunks,
                              std::map<std::uint16_t, std::uint64_t> message_counts, std::vector<MetadataEntry> metadata) {
  McapWriter writer(std::move(file));
  writer.end_ = end;
  writer.has_crc_ = false;
  writer.chunks_ = std::move(chunks);
  writer.message_counts_ = std::move(message_counts);
  writer.metadata_ = std::move(metadata);
  return writer;
}

Result<void> McapWriter::write(std::string_view bytes) {
  if (auto written = file_->write_at(end_, bytes); !written) return written;
  end_ += bytes.size();
  if (has_crc_) crc_ = mcap::crc32_of(bytes, crc_);
  return {};
}

Result<void> McapWriter::append(const McapChunk& chunk) {
  McapChunkInfo info = chunk.info;
  info.offset += end_;
  for (auto& [channel, offset] : info.index_offsets) offset += end_;
  if (auto written = write(chunk.bytes); !written) return written;
  chunks_.push_back(std::move(info));
  for (const auto& [channel, count] : chunk.message_counts) message_counts_[channel] += count;
  counts_of_appended_.push_back(chunk.message_counts);
  return {};
}

std::uint64_t McapWriter::drop_last_chunk() {
  if (counts_of_appended_.empty()) return 0;
  end_ = chunks_.back().offset;
  has_crc_ = false;
  std::uint64_t dropped = 0;
  for (const auto& [channel, count] : counts_of_appended_.back()) {
    dropped += count;
    message_counts_[channel] -= count;
    if (message_counts_[channel] == 0) message_counts_.erase(channel);
  }
  chunks_.pop_back();
  counts_of_appended_.pop_back();
  static_cast<void>(file_->truncate(end_));
  return dropped;
}

Result<void> McapWriter::append_definitions(const McapRegistry& registry) {
  std::string bytes;
  for (const auto& [id, schema] : registry.schemas) mcap::put_schema(bytes, schema);
  for (const auto& [id, channel] : registry.channels) mcap::put_channel(bytes, channel);
  return write(bytes);
}

Result<void> McapWriter::append_metadata(std::string_view name, const std::map<std::string, std::string>& values) {
  std::string bytes;
  mcap::put_metadata(bytes, name, values);
  const std::uint64_t offset = end_;
  if (auto written = write(bytes); !written) return written;
  metadata_.push_back({offset, bytes.size(), std::string(name)});
  return {};
}

std::uint64_t McapWriter::messages() const {
  std::uint64_t sum = 0;
  for (const auto& [channel, count] : message_counts_) sum += count;
  return sum;
}

/// The summary section, its offsets and the footer, as they stand when they begin at `start`.
std::string McapWriter::summary_at(std::uint64_t start, const McapRegistry& registry) const {
  std::string out, offsets;
  const auto group = [&](Op op, auto&& fill) {
    const std::size_t begin = out.size();
    fill();
    if (out.size() > begin) mcap::put_summary_offset(offsets, op, start + begin, out.size() - begin);
  };
  std::set<std::uint16_t> schemas;
  for (const auto& [id, count] : message_counts_) schemas.insert(registry.channels.at(id).schema_id);
  group(Op::kSchema, [&] {
    for (const auto& [id, schema] : registry.schemas)
      if (schemas.contains(id)) mcap::put_schema(out, schema);
  });
  group(Op::kChannel, [&] {
    for (const auto& [id, count] : message_counts_) mcap::put_channel(out, registry.channels.at(id));
  });
  group(Op::kStatistics, [&] {
    mcap::put_record(out, Op::kStatistics, [&] {
      BytePut put(out);
      std::uint64_t first = chunks_.empty() ? 0 : std::numeric_limits<std::uint64_t>::max(), last = 0;
      for (const McapChunkInfo& chunk : chunks_) {
        first = std::min(first, chunk.start_ns);
        last = std::max(last, chunk.end_ns);
      }
      put.number(messages());
      put.number(static_cast<std::uint16_t>(schemas.size() - schemas.count(0)));
      for (const std::size_t count : {message_counts_.size(), std::size_t{0}, metadata_.size(), chunks_.size()}) put.number(static_cast<std::uint32_t>(count));
      put.number(first);
      put.number(last);
      put.number(static_cast<std::uint32_t>(message_counts_.size() * 10));
      for (const auto& [id, count] : message_counts_) {
        put.number(id);
        put.number(count);
      }
    });
  });
  group(Op::kChunkIndex, [&] {
    for (const McapChunkInfo& chunk : chunks_) mcap::put_chunk_index(out, chunk);
  });
  group(Op::kMetadataIndex, [&] {
    for (const MetadataEntry& entry : metadata_)
      mcap::put_record(out, Op::kMetadataIndex, [&] {
        BytePut put(out);
        put.number(entry.offset);
        put.number(entry.length);
        put.text(entry.name);
      });
  });
  const std::uint64_t offsets_at = start + out.size();
  out += offsets;
  mcap::put_record(out, Op::kFooter, [&] {
    BytePut put(out);
    put.number(start);
    put.number(offsets_at);
    put.number(std::uint32_t{0});
  });
  const std::uint32_t crc = mcap::crc32_of(std::string_view(out).substr(0, out.size() - 4));
  out.replace(out.size() - 4, 4, reinterpret_cast<const char*>(&crc), 4);
  return out;
}

Result<void> McapWriter::finish(const McapRegistry& registry) {
  std::string bytes;
  mcap::put_record(bytes, Op::kDataEnd, [&] { BytePut(bytes).number(has_crc_ ? crc_ : 0U); });
  bytes += summary_at(end_ + bytes.size(), registry);
  bytes += mcap::kMagic;
  if (auto written = file_->write_at(end_, bytes); !written) {
    static_cast<void>(file_->truncate(end_));  // on a full disk what it left, and a refused chunk before it, is in its own way
    return written;
  }
  if (auto cut = file_->truncate(end_ + bytes.size()); !cut) return cut;
  return file_->sync();
}

}  // namespace gfp
