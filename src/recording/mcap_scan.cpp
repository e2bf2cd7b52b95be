#include "gfp/recording/mcap_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "recording/chunk_record.hpp"
#include "recording/little_endian.hpp"
#include "recording/load_chunk.hpp"
#include "recording/mcap_layout.hpp"

// How damage is told from data: a record is believed when what follows it can begin a record too. A chunk is believed when the three
// lengths in it agree (of the record, of the name of its compression, of its records); its content then has a CRC. After damage the
// next chunk is looked for byte by byte.

namespace gfp {
namespace {

using mcap::kRecordHeaderBytes;
using mcap::Op;

struct RecordHeader {
  std::uint8_t op = 0;
  std::uint64_t end = 0;  ///< Behind the record.
};

bool may_stand_in_data(std::uint8_t op) {
  switch (static_cast<Op>(op)) {
    case Op::kFooter: case Op::kChunkIndex: case Op::kAttachmentIndex: case Op::kStatistics: case Op::kMetadataIndex: case Op::kSummaryOffset: return false;
    default: return op != 0;
  }
}

constexpr std::size_t kChunkHeadBytes = kRecordHeaderBytes + mcap::kChunkFixedBytes + 4 + 4 + 8;  ///< Up to its records, with a name of 4.

/// The three lengths of a Chunk record agree, and it fits into the `left` bytes of the file; whatever its opcode.
bool begins_chunk(std::string_view head, std::uint64_t left) {
  ByteGet get(head);
  get.number<std::uint8_t>();
  const auto length = get.number<std::uint64_t>();
  get.take(mcap::kChunkFixedBytes);
  const auto name = get.number<std::uint32_t>();
  if (name > 4) return false;  // "", lz4 or zstd
  get.take(name);
  const auto records = get.number<std::uint64_t>();
  const std::uint64_t most = left - std::min(left, kRecordHeaderBytes + mcap::kChunkFixedBytes + 4 + name + 8);
  return get.ok() && records <= most && mcap::kChunkFixedBytes + 4 + name + 8 + records == length;
}

class Scanner {
 public:
  Scanner(ByteSource& source, const McapReadOptions& options) : source_(source), options_(options), size_(source.size()) {}

  Result<McapScan> run() {
    if (auto begun = skip_magic(); !begun) return tl::unexpected(begun.error());
    std::uint64_t position = mcap::kMagic.size();
    while (position < size_ && !scan_.is_finished) {
      auto next = step(position);
      if (!next) return tl::unexpected(next.error());
      position = *next;
    }
    if (!has_magic_ && scan_.chunks.empty()) return failure(ErrorCode::kCorruptData, "not an MCAP file");
    return std::move(scan_);
  }

 private:
  Result<void> skip_magic() {
    if (auto read = source_.read_at(0, mcap::kMagic.size(), buffer_); !read) return read;
    has_magic_ = buffer_ == mcap::kMagic;
    if (!has_magic_) scan_.damage.push_back({0, std::min<std::uint64_t>(size_, mcap::kMagic.size()), "the file does not begin as MCAP files do"});
    scan_.sound_end = mcap::kMagic.size();
    return {};
  }

  /// Takes in what stands at `position`; the position behind it.
  Result<std::uint64_t> step(std::uint64_t position) {
    const std::optional<RecordHeader> header = header_at(position);
    if (header && is_chunk(position)) return take_chunk(position, *header);
    const bool is_end = header && static_cast<Op>(header->op) == Op::kDataEnd && header->end == position + kRecordHeaderBytes + 4;
    if (is_end) {
      scan_.is_finished = true;
      return header->end;
    }
    if (!header || !may_begin_record(header->end) || !take_record(position, *header)) return lose(position, "bytes that are no record");
    if (scan_.messages.size() > options_.max_messages) return too_many();
    scan_.sound_end = header->end;
    return header->end;
  }

  std::optional<RecordHeader> header_at(std::uint64_t position) {
    if (!source_.read_at(position, kRecordHeaderBytes, small_) || small_.size() < kRecordHeaderBytes) return std::nullopt;
    ByteGet get(small_);
    RecordHeader header;
    header.op = get.number<std::uint8_t>();
    const auto length = get.number<std::uint64_t>();
    if (length > size_ - position - kRecordHeaderBytes || !may_stand_in_data(header.op)) return std::nullopt;
    header.end = position + kRecordHeaderBytes + length;
    return header;
  }

  bool may_begin_record(std::uint64_t position) { return position == size_ || header_at(position).has_value(); }

  bool is_chunk(std::uint64_t position) {
    return source_.read_at(position, kChunkHeadBytes, small_).has_value() && begins_chunk(small_, size_ - position);
  }

  Result<std::uint64_t> take_chunk(std::uint64_t position, const RecordHeader& header) {
    const std::uint64_t length = header.end - position;
    if (length > options_.max_chunk_bytes) return lose(position, fmt::format("a chunk of {} bytes, at most {} are read", length, options_.max_chunk_bytes));
    if (auto read = source_.read_at(position, static_cast<std::size_t>(length), buffer_); !read) return tl::unexpected(read.error());
    const auto content = mcap::chunk_from(std::string_view(buffer_).substr(std::min<std::size_t>(buffer_.size(), kRecordHeaderBytes)));
    if (!content) return lose_chunk(position, header, "a chunk that is no chunk");
    if (auto done = mcap::decompress_chunk(*content, options_, records_); !done) return lose_chunk(position, header, done.error().what);
    const auto number = static_cast<std::uint32_t>(scan_.chunks.size());
    const std::size_t messages_before = scan_.messages.size();
    McapRegistry found;
    mcap::MessageTimes times;
    const auto visited = mcap::visit_records(records_, {[&](McapSchema schema) { found.schemas[schema.id] = std::move(schema); },
                                                        [&](McapChannel channel) { found.channels[channel.id] = std::move(channel); },
                                                        [&](std::uint64_t offset, const McapMessage& message) {
                                                          scan_.messages.push_back({message.log_time_ns, offset, number, message.channel});
                                                          times[message.channel].emplace_back(message.log_time_ns, offset);
                                                        }});
    if (!visited) {
      scan_.messages.resize(messages_before);
      return lose_chunk(position, header, visited.error().what);
    }
    if (scan_.messages.size() > options_.max_messages) return too_many();
    for (auto& [id, schema] : found.schemas) scan_.registry.schemas.insert_or_assign(id, std::move(schema));
    for (auto& [id, channel] : found.channels) scan_.registry.channels.insert_or_assign(id, std::move(channel));
    // What follows a sound chunk as it was written is known: the same bytes again mean a sound index.
    const auto again = mcap::make_chunk(std::move(times), content->uncompressed_bytes, content->crc, std::string(content->compression),
                                        [&](std::string& out) -> Result<void> { return out.append(content->records), Result<void>{}; });
    if (!again) return tl::unexpected(again.error());
    scan_.chunks.push_back({again->info, has_index(position, *again)});
    place(scan_.chunks.back().info, position, length);
    if (static_cast<Op>(header.op) != Op::kChunk) scan_.damage.push_back({position, position + 1, "the opcode of a chunk"});
    scan_.sound_end = header.end;
    return header.end;
  }

  /// The chunk's MessageIndex records follow, as we would write them, and the chunk itself is what we would write.
  bool has_index(std::uint64_t position, const McapChunk& again) {
    std::string there;
    return source_.read_at(position, again.bytes.size(), there) && there == again.bytes;
  }

  static void place(McapChunkInfo& info, std::uint64_t position, std::uint64_t length) {
    info.offset += position;
    info.length = length;
    for (auto& [channel, offset] : info.index_offsets) offset += position;
  }

  /// A record of the data section that is no chunk; false: its content is damaged.
  bool take_record(std::uint64_t position, const RecordHeader& header) {
    const std::uint64_t content = header.end - position - kRecordHeaderBytes;
    const auto read = [&](std::uint64_t most) {
      return content <= most && source_.read_at(position + kRecordHeaderBytes, static_cast<std::size_t>(content), buffer_).has_value();
    };
    switch (static_cast<Op>(header.op)) {
      case Op::kSchema: {
        const auto schema = read(options_.max_definition_bytes) ? mcap::schema_from(buffer_) : std::nullopt;
        if (schema) scan_.registry.schemas.try_emplace(schema->id, *schema);
        return schema.has_value();
      }
      case Op::kChannel: {
        const auto channel = read(options_.max_definition_bytes) ? mcap::channel_from(buffer_) : std::nullopt;
        if (channel) scan_.registry.channels.try_emplace(channel->id, *channel);
        return channel.has_value();
      }
      case Op::kMessage: {
        if (!source_.read_at(position + kRecordHeaderBytes, 22, buffer_)) return false;
        const auto message = mcap::message_from(buffer_);
        if (message) scan_.messages.push_back({message->log_time_ns, position, McapMessageRef::kLoose, message->channel});
        return message.has_value();
      }
      case Op::kMessageIndex: {
        ByteGet get(read(options_.max_chunk_bytes) ? std::string_view(buffer_) : std::string_view());
        get.number<std::uint16_t>();
        const std::uint32_t length = get.number<std::uint32_t>();
        return get.ok() && length == get.left() && length % 16 == 0;
      }
      case Op::kMetadata: {
        auto found = read(options_.max_definition_bytes) ? mcap::metadata_from(buffer_) : std::nullopt;
        if (found) scan_.metadata.push_back({position, header.end - position, std::move(found->first), std::move(found->second)});
        return found.has_value();
      }
      case Op::kChunk: return false;  // its lengths disagree
      default: return true;
    }
  }

  /// Where a record follows it, the damage is the chunk's own: what stands between it and the next one is not lost with it.
  Result<std::uint64_t> lose_chunk(std::uint64_t position, const RecordHeader& header, std::string why) {
    if (!may_begin_record(header.end)) return lose(position, std::move(why));
    scan_.damage.push_back({position, header.end, std::move(why)});
    return header.end;
  }

  /// Notes the damage that begins here and finds the next chunk.
  Result<std::uint64_t> lose(std::uint64_t position, std::string why) {
    constexpr std::size_t kWindow = 1U << 16, kMaxDamage = 10'000;
    if (scan_.damage.size() >= kMaxDamage) return failure(ErrorCode::kCorruptData, fmt::format("damaged in more than {} places", kMaxDamage));
    std::uint64_t next = size_;
    std::string window;
    for (std::uint64_t base = position + 1; base < size_ && next == size_; base += kWindow) {
      if (auto read = source_.read_at(base, kWindow + kChunkHeadBytes, window); !read) return tl::unexpected(read.error());
      for (std::size_t at = window.find('\x06'); at < kWindow && next == size_; at = window.find('\x06', at + 1))
        if (begins_chunk(std::string_view(window).substr(at, kChunkHeadBytes), size_ - base - at)) next = base + at;
    }
    if (!scan_.damage.empty() && scan_.damage.back().end == position) scan_.damage.back().end = next;
    else scan_.damage.push_back({position, next, std::move(why)});
    return next;
  }

  tl::unexpected<Error> too_many() const {
    return failure(ErrorCode::kTooLarge, fmt::format("more than {} messages in one file", options_.max_messages));
  }

  ByteSource& source_;
  const McapReadOptions& options_;
  const std::uint64_t size_;
  bool has_magic_ = false;
  McapScan scan_;
  std::string buffer_, small_, records_;
};

}  // namespace

Result<McapScan> scan_mcap(ByteSource& source, const McapReadOptions& options) { return Scanner(source, options).run(); }

}  // namespace gfp
