#include "gfp/recording/recording_series.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <utility>

// States of a series:  continuous: recording <-> no space | failing, and back with the next chunk that can be written.
//                      ring: idle --trigger--> recording for `after_trigger_s` --> idle.
// A file is opened by the first chunk that goes into it and closed by size, time, lack of space or the end.

namespace gfp {
namespace {

using State = RecordingStatus::State;

Nanoseconds seconds(double value) { return Nanoseconds(std::llround(1e9 * value)); }
std::uint64_t megabytes(double value) { return static_cast<std::uint64_t>(1e6 * value); }

constexpr std::uint64_t kRoomForEnd = 1U << 20U;  ///< Bytes, of the summary of an hour.
constexpr Nanoseconds kChunkAge{200'000'000}, kSyncAge{800'000'000}, kSpaceAge{1'000'000'000};

std::uint64_t messages_in(const McapChunk& chunk) {
  std::uint64_t sum = 0;
  for (const auto& [channel, count] : chunk.message_counts) sum += count;
  return sum;
}

}  // namespace

RecordingSeries::RecordingSeries(RecordingOptions options, RecordingStorage& storage)
    : options_(std::move(options)), storage_(storage), encoder_(McapEncoderOptions{1U << 20U, static_cast<std::uint64_t>(kChunkAge.count()), options_.zstd_level}) {}

RecordingSeries::~RecordingSeries() { close(); }

void RecordingSeries::put(const McapChannelSpec& spec, McapMessage message, Now now) {
  if (options_.mode == "off") return;
  auto channel = channels_.find(spec.topic);
  if (channel == channels_.end()) {
    const auto added = encoder_.add_channel(spec);
    if (!added) return fail(added.error(), 1);
    channel = channels_.emplace(spec.topic, *added).first;
  }
  message.channel = channel->second;
  if (encoder_.waiting_messages() == 0) chunk_began_ = now;
  const std::size_t waiting = encoder_.waiting_messages() + 1;
  take(encoder_.add(message), waiting, now);
}

void RecordingSeries::tick(Now now) {
  if (encoder_.waiting_messages() > 0 && now - chunk_began_ >= kChunkAge) take(encoder_.flush(), encoder_.waiting_messages(), now);
  if (writer_ && needs_sync_ && now - synced_ >= kSyncAge) {
    if (auto synced = writer_->sync(); !synced) fail(synced.error(), 0);
    needs_sync_ = false;
    synced_ = now;
  }
  if (record_until_ && now >= *record_until_) {
    take(encoder_.flush(), encoder_.waiting_messages(), now);
    record_until_.reset();
    finish_file();
  }
}

void RecordingSeries::trigger(Now now) {
  if (options_.mode != "ring") return;
  record_until_ = now + seconds(options_.after_trigger_s);
  while (!ring_.empty()) {
    write(ring_.front().chunk, now);
    ring_.pop_front();
  }
  ring_bytes_ = 0;
}

void RecordingSeries::close() {
  const bool writes = options_.mode == "continuous" || record_until_;
  if (writes) take(encoder_.flush(), encoder_.waiting_messages(), space_checked_);
  finish_file();
}

void RecordingSeries::take(Result<std::optional<McapChunk>> chunk, std::size_t waiting, Now now) {
  if (!chunk) return fail(chunk.error(), waiting);
  if (!*chunk) return;
  if (options_.mode == "ring" && !record_until_) keep_in_ring(std::move(**chunk), now);
  else write(**chunk, now);
}

void RecordingSeries::keep_in_ring(McapChunk chunk, Now now) {
  ring_bytes_ += chunk.bytes.size();
  ring_.push_back({std::move(chunk), now});
  while (!ring_.empty() && (ring_bytes_ > megabytes(options_.ring_mb) || now - ring_.front().since > seconds(options_.ring_s))) {
    ring_bytes_ -= ring_.front().chunk.bytes.size();
    ring_.pop_front();
  }
}

void RecordingSeries::write(const McapChunk& chunk, Now now) {
  const std::uint64_t messages = messages_in(chunk);
  const bool is_full = writer_ && (writer_->bytes() + chunk.bytes.size() > megabytes(options_.max_file_mb) || now - file_began_ > seconds(options_.max_file_s));
  if (is_full) finish_file();
  if (!has_space(now)) {
    finish_file();
    status_.state = State::kNoSpace;
    status_.lost_messages += messages;
    return;
  }
  next_file_time_ns_ = chunk.info.start_ns;
  if (!writer_ && !open_file(now)) {
    status_.lost_messages += messages;
    return;
  }
  if (auto written = writer_->append(chunk); !written) return fail(written.error(), messages);
  status_.state = State::kRecording;
  status_.messages += messages;
  status_.bytes += chunk.bytes.size();
  if (!needs_sync_) synced_ = now;  // a second at most from the first byte that a power loss could take
  needs_sync_ = true;
}

std::filesystem::path RecordingSeries::next_name(std::uint64_t first_log_time_ns) const {
  const auto time = static_cast<std::time_t>(first_log_time_ns / 1'000'000'000);
  const std::string stem = fmt::format("{}_{:%Y%m%dT%H%M%S}.{:03}Z", options_.prefix, fmt::gmtime(time), first_log_time_ns / 1'000'000 % 1000);
  const std::filesystem::path folder = options_.folder;
  std::filesystem::path name = folder / (stem + ".mcap");
  std::error_code ignored;
  for (int count = 2; std::filesystem::exists(name, ignored) || std::filesystem::exists(name.string() + ".active", ignored); ++count)
    name = folder / fmt::format("{}-{}.mcap", stem, count);
  return name;
}

bool RecordingSeries::open_file(Now now) {
  final_name_ = next_name(next_file_time_ns_);
  auto file = storage_.create(final_name_.string() + ".active");
  if (!file) return fail(file.error(), 0), false;
  auto writer = McapWriter::begin(std::move(*file));
  if (!writer) {
    fail(writer.error(), 0);
    static_cast<void>(storage_.remove(final_name_.string() + ".active"));  // it holds nothing
    return false;
  }
  writer_.emplace(std::move(*writer));
  file_began_ = now;
  status_.file = final_name_.string() + ".active";
  return true;
}

void RecordingSeries::finish_file() {
  if (!writer_) return;
  const std::filesystem::path active = status_.file;
  Result<void> finished = writer_->finish(encoder_.registry());
  bool again = true;
  while (!finished && again) {  // a refusal may pass; where nothing helps, repair will do it
    ++status_.write_errors;
    status_.last_error = finished.error().what;
    finished = writer_->finish(encoder_.registry());
    again = !finished && make_room_for_end();
  }
  writer_.reset();
  status_.file.clear();
  status_.state = State::kIdle;
  needs_sync_ = false;
  if (finished) finished = storage_.rename(active, final_name_);
  if (!finished) return fail(finished.error(), 0);
  ++status_.files;
}

/// On a full disk the last chunk gives its place to what makes the others readable.
bool RecordingSeries::make_room_for_end() {
  const auto free = storage_.free_bytes(options_.folder);
  if (!free || *free >= kRoomForEnd) return false;
  const std::uint64_t messages = writer_->drop_last_chunk();
  status_.messages -= messages;
  status_.lost_messages += messages;
  return messages > 0;
}

/// Looks once a second; makes room where it is told to.
bool RecordingSeries::has_space(Now now) {
  if (space_checked_ >= Now(0) && now - space_checked_ < kSpaceAge) return has_space_;
  space_checked_ = now;
  const std::uint64_t needed = megabytes(options_.min_free_mb);
  const auto enough = [&] {
    const auto free = storage_.free_bytes(options_.folder);
    return !free || *free >= needed;  // where nobody knows, the write itself will tell
  };
  has_space_ = enough();
  if (has_space_ || !options_.delete_oldest) return has_space_;
  for (const std::filesystem::path& file : storage_.closed_files(options_.folder, options_.prefix)) {
    if (auto removed = storage_.remove(file); !removed) fail(removed.error(), 0);
    has_space_ = enough();
    if (has_space_) break;
  }
  return has_space_;
}

void RecordingSeries::fail(const Error& error, std::uint64_t messages) {
  ++status_.write_errors;
  status_.lost_messages += messages;
  status_.last_error = error.what;
  status_.state = State::kFailing;
}

}  // namespace gfp
