#include "gfp/recording/repair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "gfp/recording/mcap_reader.hpp"
#include "gfp/recording/mcap_writer.hpp"
#include "recording/chunk_record.hpp"
#include "recording/load_chunk.hpp"
#include "recording/mcap_layout.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;
using Outcome = RepairReport::Outcome;

struct Patient {
  std::unique_ptr<ByteSource> source;
  McapScan scan;
  bool has_summary = false;  ///< That speaks of the chunks that are there.
};

/// The summary is right when it can be read and speaks of every chunk.
bool has_summary(const fs::path& file, const McapScan& scan, const McapReadOptions& options) {
  auto reader = McapReader::open(file, options);
  if (!reader || !reader->has_index()) return false;
  const auto messages = reader->messages([](const McapChannel&) { return true; });
  return messages && reader->damage().empty() && messages->size() == scan.messages.size();
}

Result<Patient> examine(const fs::path& file, const McapReadOptions& options) {
  auto source = open_source(file);
  if (!source) return tl::unexpected(source.error());
  auto scan = scan_mcap(**source, options);
  if (!scan) return failure(scan.error().code, fmt::format("{}: {}", file.string(), scan.error().what));
  if (scan->messages.empty()) return failure(ErrorCode::kCorruptData, fmt::format("{}: no message that is whole", file.string()));
  // Channels that no sound chunk defines may still be in the summary.
  if (auto reader = McapReader::open(file, options); reader && reader->has_index()) {
    for (const auto& [id, schema] : reader->registry().schemas) scan->registry.schemas.try_emplace(id, schema);
    for (const auto& [id, channel] : reader->registry().channels) scan->registry.channels.try_emplace(id, channel);
  }
  // A message of a channel that nothing defines cannot be told from noise.
  std::erase_if(scan->messages, [&](const McapMessageRef& ref) { return !scan->registry.channels.contains(ref.channel); });
  Patient patient{std::move(*source), std::move(*scan), false};
  patient.has_summary = patient.scan.is_finished && patient.scan.damage.empty() && has_summary(file, patient.scan, options);
  return patient;
}

bool has_loose_messages(const McapScan& scan) {
  return std::any_of(scan.messages.begin(), scan.messages.end(), [](const McapMessageRef& ref) { return ref.chunk == McapMessageRef::kLoose; });
}

using TimesByChunk = std::map<std::uint32_t, mcap::MessageTimes>;

TimesByChunk times_by_chunk(const McapScan& scan) {
  TimesByChunk times;
  for (const McapMessageRef& ref : scan.messages) times[ref.chunk][ref.channel].emplace_back(ref.log_time_ns, ref.offset);
  return times;
}

/// The chunk again, its records as they are, with everything that is not under their CRC written anew.
Result<McapChunk> chunk_anew(Patient& patient, std::uint32_t number, mcap::MessageTimes times) {
  const McapChunkInfo& info = patient.scan.chunks[number].info;
  std::string bytes;
  if (auto read = patient.source->read_at(info.offset, static_cast<std::size_t>(info.length), bytes); !read) return tl::unexpected(read.error());
  const auto content = mcap::chunk_from(std::string_view(bytes).substr(std::min(bytes.size(), mcap::kRecordHeaderBytes)));
  if (!content) return failure(ErrorCode::kIo, fmt::format("the chunk at byte {} changed while it was read", info.offset));
  return mcap::make_chunk(std::move(times), content->uncompressed_bytes, content->crc, std::string(content->compression),
                          [&](std::string& out) -> Result<void> { return out.append(content->records), Result<void>{}; });
}

RepairReport report_of(const Patient& patient, Outcome outcome) {
  return {outcome, patient.scan.messages.size(), patient.scan.chunks.size(), patient.scan.damage};
}

/// All damage is what a write that broke off left at the end.
bool is_cut_only(const McapScan& scan) {
  return scan.damage.empty() || (scan.damage.size() == 1 && scan.damage.front().begin >= scan.sound_end && !scan.is_finished);
}

/// Every chunk but the last has its index: then the end alone needs writing.
bool can_close_in_place(const McapScan& scan) {
  if (!is_cut_only(scan) || scan.chunks.empty() || has_loose_messages(scan)) return false;
  return std::all_of(scan.chunks.begin(), scan.chunks.end() - 1, [](const McapScan::Chunk& chunk) { return chunk.has_sound_index; });
}

Result<void> append_metadata(const std::vector<McapMetadata>& metadata, McapWriter& writer) {
  for (const McapMetadata& one : metadata)
    if (auto appended = writer.append_metadata(one.name, one.values); !appended) return appended;
  return {};
}

Result<RepairReport> close_in_place(const fs::path& file, Patient patient) {
  TimesByChunk times = times_by_chunk(patient.scan);
  const auto last = static_cast<std::uint32_t>(patient.scan.chunks.size() - 1);
  auto chunk = chunk_anew(patient, last, std::move(times[last]));
  if (!chunk) return tl::unexpected(chunk.error());
  auto out = open_file_for_update(file);
  if (!out) return tl::unexpected(out.error());
  std::vector<McapChunkInfo> before;
  std::map<std::uint16_t, std::uint64_t> counts;
  for (std::uint32_t i = 0; i < last; ++i) {
    before.push_back(patient.scan.chunks[i].info);
    for (const auto& [channel, messages] : times[i]) counts[channel] += messages.size();
  }
  const std::uint64_t end = patient.scan.chunks[last].info.offset;
  std::vector<McapWriter::MetadataEntry> kept;
  std::vector<McapMetadata> behind;  // what is written over is written again
  for (const McapMetadata& one : patient.scan.metadata) {
    if (one.offset < end) kept.push_back({one.offset, one.length, one.name});
    else behind.push_back(one);
  }
  McapWriter writer = McapWriter::resume(std::move(*out), end, std::move(before), std::move(counts), std::move(kept));
  if (auto appended = writer.append(*chunk); !appended) return tl::unexpected(appended.error());
  if (auto appended = append_metadata(behind, writer); !appended) return tl::unexpected(appended.error());
  if (auto finished = writer.finish(patient.scan.registry); !finished) return tl::unexpected(finished.error());
  return report_of(patient, Outcome::kClosed);
}

Result<void> append_loose(Patient& patient, const McapReadOptions& options, McapWriter& writer) {
  McapEncoder encoder;
  encoder.adopt(patient.scan.registry);
  std::string bytes;
  for (const McapMessageRef& ref : patient.scan.messages) {
    if (ref.chunk != McapMessageRef::kLoose) continue;
    if (auto read = mcap::read_record(*patient.source, ref.offset, options.max_chunk_bytes, bytes); !read) return read;
    const auto record = mcap::RecordWalk(bytes).next();
    const auto message = record ? mcap::message_from(record->content) : std::nullopt;
    if (!message) return failure(ErrorCode::kIo, fmt::format("the message at byte {} changed while it was read", ref.offset));
    auto chunk = encoder.add(*message);
    if (!chunk) return tl::unexpected(chunk.error());
    if (*chunk) {
      if (auto appended = writer.append(**chunk); !appended) return appended;
    }
  }
  const auto rest = encoder.flush();
  if (!rest) return tl::unexpected(rest.error());
  return *rest ? writer.append(**rest) : Result<void>();
}

Result<RepairReport> copy_sound_part(Patient patient, const fs::path& output, const McapReadOptions& options) {
  auto out = create_file(output);
  if (!out) return tl::unexpected(out.error());
  auto writer = McapWriter::begin(std::move(*out));
  if (!writer) return tl::unexpected(writer.error());
  if (auto written = writer->append_definitions(patient.scan.registry); !written) return tl::unexpected(written.error());
  for (auto& [number, times] : times_by_chunk(patient.scan)) {
    if (number == McapMessageRef::kLoose) continue;
    auto chunk = chunk_anew(patient, number, std::move(times));
    if (!chunk) return tl::unexpected(chunk.error());
    if (auto appended = writer->append(*chunk); !appended) return tl::unexpected(appended.error());
  }
  if (auto appended = append_loose(patient, options, *writer); !appended) return tl::unexpected(appended.error());
  if (auto appended = append_metadata(patient.scan.metadata, *writer); !appended) return tl::unexpected(appended.error());
  if (auto finished = writer->finish(patient.scan.registry); !finished) return tl::unexpected(finished.error());
  return report_of(patient, is_cut_only(patient.scan) ? Outcome::kClosed : Outcome::kLost);
}

}  // namespace

Result<RepairReport> repair_mcap(const fs::path& file, const McapReadOptions& options) {
  if (is_being_written(file)) return failure(ErrorCode::kIo, fmt::format("{}: another process is writing it", file.string()));
  auto patient = examine(file, options);
  if (!patient) return tl::unexpected(patient.error());
  if (patient->has_summary) return report_of(*patient, Outcome::kSound);
  if (can_close_in_place(patient->scan)) return close_in_place(file, std::move(*patient));
  const fs::path copy = file.string() + ".repairing";
  auto report = copy_sound_part(std::move(*patient), copy, options);
  std::error_code error;
  if (report) fs::rename(copy, file, error);
  if (report && !error) return report;
  std::error_code ignored;
  fs::remove(copy, ignored);
  return report ? failure(ErrorCode::kIo, fmt::format("{}: cannot be replaced: {}", file.string(), error.message())) : report;
}

Result<RepairReport> repair_mcap_to(const fs::path& file, const fs::path& output, const McapReadOptions& options) {
  std::error_code error;
  if (fs::exists(output, error)) return failure(ErrorCode::kInvalidArgument, fmt::format("{}: exists already", output.string()));
  auto patient = examine(file, options);
  if (!patient) return tl::unexpected(patient.error());
  const bool is_sound = patient->has_summary;
  auto report = copy_sound_part(std::move(*patient), output, options);
  if (report && is_sound) report->outcome = Outcome::kSound;
  return report;
}

}  // namespace gfp
