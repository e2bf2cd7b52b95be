#include "gfp/recording/mcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "recording/little_endian.hpp"
#include "recording/load_chunk.hpp"
#include "recording/mcap_layout.hpp"

namespace gfp {

using mcap::kRecordHeaderBytes;
using mcap::Op;

namespace {

tl::unexpected<Error> with_name(const std::string& name, const Error& error) { return failure(error.code, fmt::format("{}: {}", name, error.what)); }

}  // namespace

Result<McapReader> McapReader::open(const std::filesystem::path& path, const McapReadOptions& options) {
  auto source = open_source(path);
  if (!source) return tl::unexpected(source.error());
  return open(std::move(*source), path.string(), options);
}

Result<McapReader> McapReader::open(std::unique_ptr<ByteSource> source, std::string name, const McapReadOptions& options) {
  McapReader reader(std::move(source), std::move(name), options);
  reader.has_index_ = reader.read_summary();
  if (reader.has_index_) return reader;
  auto scan = scan_mcap(*reader.source_, options);
  if (!scan) return with_name(reader.name_, scan.error());
  reader.registry_ = std::move(scan->registry);
  reader.scanned_ = std::move(scan->messages);
  reader.damage_ = std::move(scan->damage);
  reader.chunks_.clear();
  for (McapScan::Chunk& chunk : scan->chunks) reader.chunks_.push_back(std::move(chunk.info));
  return reader;
}

const McapSchema* McapReader::schema_of(const McapChannel& channel) const {
  const auto found = registry_.schemas.find(channel.schema_id);
  return found == registry_.schemas.end() ? nullptr : &found->second;
}

/// True: the file ends with a whole summary that speaks of chunks, and every chunk lies inside the file.
bool McapReader::read_summary() {
  const std::uint64_t size = source_->size(), tail = mcap::kFooterBytes + mcap::kMagic.size();
  if (size < mcap::kMagic.size() + tail || !source_->read_at(size - tail, tail, buffer_) || !buffer_.ends_with(mcap::kMagic)) return false;
  ByteGet footer(buffer_);
  const bool is_footer = footer.number<std::uint8_t>() == static_cast<std::uint8_t>(Op::kFooter) && footer.number<std::uint64_t>() == 20;
  const auto start = footer.number<std::uint64_t>();
  footer.number<std::uint64_t>();
  const auto crc = footer.number<std::uint32_t>();
  const std::uint64_t end = size - tail;
  if (!is_footer || start < mcap::kMagic.size() || start >= end || end - start > options_.max_definition_bytes + size / 16) return false;
  std::string summary;
  const std::size_t covered = static_cast<std::size_t>(end - start) + mcap::kFooterBytes - 4;
  if (!source_->read_at(start, covered, summary) || summary.size() != covered || (crc != 0 && mcap::crc32_of(summary) != crc)) return false;
  mcap::RecordWalk walk(std::string_view(summary).substr(0, static_cast<std::size_t>(end - start)));
  while (const std::optional<mcap::Record> record = walk.next()) {
    if (static_cast<Op>(record->op) == Op::kSchema) {
      auto schema = mcap::schema_from(record->content);
      if (!schema) return false;
      registry_.schemas[schema->id] = std::move(*schema);
    } else if (static_cast<Op>(record->op) == Op::kChannel) {
      auto channel = mcap::channel_from(record->content);
      if (!channel) return false;
      registry_.channels[channel->id] = std::move(*channel);
    } else if (static_cast<Op>(record->op) == Op::kChunkIndex) {
      auto chunk = mcap::chunk_index_from(record->content);
      if (!chunk || chunk->offset > size || chunk->length > size - chunk->offset || chunk->length < kRecordHeaderBytes || chunk->index_length > size) return false;
      chunks_.push_back(std::move(*chunk));
    }
  }
  return walk.sound() && !chunks_.empty() && !registry_.channels.empty();
}

/// What the MessageIndex records of a chunk say; false where they break their format or cannot be true.
bool McapReader::add_from_index(std::uint32_t number, std::vector<McapMessageRef>& all) {
  const McapChunkInfo& chunk = chunks_[number];
  if (chunk.index_offsets.empty() || chunk.index_length > options_.max_chunk_bytes) return false;
  if (!source_->read_at(chunk.offset + chunk.length, static_cast<std::size_t>(chunk.index_length), buffer_)) return false;
  mcap::RecordWalk walk(buffer_);
  std::size_t indices = 0;
  while (const std::optional<mcap::Record> record = walk.next()) {
    if (static_cast<Op>(record->op) != Op::kMessageIndex) return false;
    ByteGet get(record->content);
    const auto channel = get.number<std::uint16_t>();
    ByteGet entries(get.text());
    if (!get.ok() || !get.at_end() || entries.left() % 16 != 0 || !chunk.index_offsets.contains(channel)) return false;
    ++indices;
    while (!entries.at_end()) {
      const auto time = entries.number<std::uint64_t>();
      const auto offset = entries.number<std::uint64_t>();
      if (time < chunk.start_ns || time > chunk.end_ns || offset >= chunk.uncompressed_bytes) return false;
      all.push_back({time, offset, number, channel});
    }
  }
  return walk.sound() && indices == chunk.index_offsets.size();
}

/// The messages of one chunk, from its index or else from itself.
Result<void> McapReader::add_indexed(std::uint32_t number, std::vector<McapMessageRef>& all) {
  const std::size_t before = all.size();
  if (add_from_index(number, all)) return {};
  all.resize(before);
  const auto records = chunk_records(number);
  if (!records) return tl::unexpected(records.error());
  auto visited = mcap::visit_records(**records, {{}, {}, [&](std::uint64_t offset, const McapMessage& message) {
                                                   all.push_back({message.log_time_ns, offset, number, message.channel});
                                                 }});
  if (!visited) all.resize(before);
  return visited;
}

Result<std::vector<McapMessageRef>> McapReader::messages(const std::function<bool(const McapChannel&)>& wanted) {
  std::vector<bool> is_wanted(1U << 16U, false);
  for (const auto& [id, channel] : registry_.channels) is_wanted[id] = wanted(channel);
  std::vector<McapMessageRef> all = has_index_ ? std::vector<McapMessageRef>() : scanned_;
  const auto drop_unwanted = [&](std::size_t from) {
    all.erase(std::remove_if(all.begin() + static_cast<std::ptrdiff_t>(from), all.end(), [&](const McapMessageRef& ref) { return !is_wanted[ref.channel]; }), all.end());
  };
  if (!has_index_) drop_unwanted(0);
  for (std::uint32_t number = 0; has_index_ && number < chunks_.size(); ++number) {
    const McapChunkInfo& chunk = chunks_[number];
    const std::size_t before = all.size();
    const bool concerns = chunk.index_offsets.empty() || std::any_of(chunk.index_offsets.begin(), chunk.index_offsets.end(), [&](const auto& entry) { return is_wanted[entry.first]; });
    if (!concerns) continue;
    if (const auto added = add_indexed(number, all); !added) damage_.push_back({chunk.offset, chunk.offset + chunk.length, added.error().what});
    drop_unwanted(before);
    if (all.size() > options_.max_messages)
      return with_name(name_, {ErrorCode::kTooLarge, fmt::format("more than {} messages in one file", options_.max_messages)});
  }
  const auto order = [](const McapMessageRef& a, const McapMessageRef& b) {
    return std::tie(a.log_time_ns, a.chunk, a.offset) < std::tie(b.log_time_ns, b.chunk, b.offset);
  };
  if (!std::is_sorted(all.begin(), all.end(), order)) std::sort(all.begin(), all.end(), order);
  return all;
}

Result<const std::string*> McapReader::chunk_records(std::uint32_t number) {
  constexpr std::size_t kCached = 2;  // neighbours in time are in one chunk or in two
  const auto found = std::find_if(cache_.begin(), cache_.end(), [&](const auto& entry) { return entry.first == number; });
  if (found != cache_.end()) return &found->second;
  const McapChunkInfo& chunk = chunks_[number];
  if (chunk.length > options_.max_chunk_bytes)
    return failure(ErrorCode::kTooLarge, fmt::format("a chunk of {} bytes, at most {} are read", chunk.length, options_.max_chunk_bytes));
  std::string bytes;
  if (auto read = source_->read_at(chunk.offset, static_cast<std::size_t>(chunk.length), bytes); !read) return tl::unexpected(read.error());
  mcap::RecordWalk walk(bytes);
  const auto record = walk.next();
  const auto content = record ? mcap::chunk_from(record->content) : std::nullopt;
  if (!content) return failure(ErrorCode::kCorruptData, fmt::format("byte {} is not the beginning of a chunk", chunk.offset));
  std::string records = cache_.size() < kCached ? std::string() : std::move(cache_.back().second);
  if (cache_.size() == kCached) cache_.pop_back();
  if (auto done = mcap::decompress_chunk(*content, options_, records); !done) return tl::unexpected(done.error());
  cache_.emplace_front(number, std::move(records));
  return &cache_.front().second;
}

Result<McapMessage> McapReader::read(const McapMessageRef& ref) {
  std::string_view bytes;
  if (ref.chunk == McapMessageRef::kLoose) {
    if (auto read = mcap::read_record(*source_, ref.offset, options_.max_chunk_bytes, buffer_); !read) return with_name(name_, read.error());
    bytes = buffer_;
  } else {
    const auto records = chunk_records(ref.chunk);
    if (!records) return with_name(name_, {records.error().code, fmt::format("chunk {}: {}", ref.chunk, records.error().what)});
    bytes = std::string_view(**records).substr(std::min<std::size_t>(ref.offset, (*records)->size()));
  }
  const auto record = mcap::RecordWalk(bytes).next();
  const auto message = record && static_cast<Op>(record->op) == Op::kMessage ? mcap::message_from(record->content) : std::nullopt;
  if (!message || message->channel != ref.channel || message->log_time_ns != ref.log_time_ns)
    return with_name(name_, {ErrorCode::kCorruptData, fmt::format("no message where the index says, at byte {} of chunk {}", ref.offset, ref.chunk)});
  return *message;
}

}  // namespace gfp
