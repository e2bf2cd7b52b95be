// Kills, rotten bits, refused writes and power losses of recordings, in great numbers.
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include <atomic>
#include <csignal>
#include <functional>

#include "gfp/core/time.hpp"
#include "gfp/recording/recording_series.hpp"
#include "gfp/recording/repair.hpp"
#include "recording/sample_recording.hpp"
#include "support/soak_ledger.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using test::Trial;

constexpr std::uint32_t kSamples = 3000;

const McapChannelSpec kSpecs[3] = {{"/one/", "test", "a", "text", std::string(300, 'a'), {}}, {"/two/", "test", "b", "text", "b", {}}, {"/three/", "test", "c", "text", "c", {}}};

/// All messages of the recordings of a folder; a message that is other than it was (cut to `most_bytes`) is a failure.
std::map<std::uint32_t, bool> read_folder(const std::filesystem::path& folder, std::string& failure, std::size_t most_bytes = std::string::npos) {
  std::map<std::uint32_t, bool> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".mcap") continue;
    auto reader = McapReader::open(entry.path());
    if (!reader || !reader->has_index()) {
      failure = entry.path().string() + " is not readable through its index";
      continue;
    }
    for (const auto& [i, message] : test::all_messages(*reader)) {
      if (message.data != test::sample_message(i % kSamples).data.substr(0, most_bytes)) failure = "message " + std::to_string(i) + " is damaged";
      found[i] = true;
    }
  }
  return found;
}

/// What the child tells of itself until it is killed.
struct Shared {
  std::atomic<std::uint64_t> handed{0};   ///< Messages that were given to the recording.
  std::atomic<std::uint64_t> written{0};  ///< Messages whose chunk was handed to the system.
};

[[noreturn]] void record_until_killed(const std::filesystem::path& folder, Shared& shared) {
  RecordingOptions options;
  options.mode = "continuous";
  options.folder = folder.string();
  options.min_free_mb = 0;
  options.max_file_s = 1;
  options.max_file_mb = 1;  // so that some kills hit the end of a file
  const auto storage = disk_storage();
  RecordingSeries series(options, *storage);
  for (std::uint32_t i = 0;; ++i) {
    McapMessage message = test::as_message(test::sample_message(i % kSamples), i);
    message.log_time_ns = 1'000'000'000ULL + 1'000'000ULL * i;
    series.put(kSpecs[i % 3], message, monotonic_now());
    series.tick(monotonic_now());
    shared.handed = i + 1;
    shared.written = series.status().messages;
  }
}

/// SIGKILL after a random time: what was written is there, and nothing else is wrong.
Trial kill_trial(std::uint64_t seed) {
  const test::TemporaryFolder folder;
  auto* shared = new (mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Shared;
  const pid_t child = fork();
  if (child == 0) record_until_killed(folder / "r", *shared);
  Random random(seed);
  while (shared->handed == 0) usleep(100);
  usleep(static_cast<useconds_t>(random.below(120'000)));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  Trial trial;
  std::filesystem::create_directories(folder / "r");
  recover_recordings(folder / "r", "gfp");
  const auto found = read_folder(folder / "r", trial.failure);
  if (found.size() < shared->written) trial.failure = std::to_string(shared->written - found.size()) + " written messages are gone";
  trial.measured("messages_max", found.size());
  trial.measured("lost_messages_max", shared->handed - std::min<std::uint64_t>(shared->handed, found.size()));
  munmap(shared, sizeof(Shared));
  return trial;
}

struct Sample {
  std::string bytes;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> chunks;       ///< Bytes [begin, end).
  std::vector<std::vector<std::uint32_t>> messages;                  ///< Of each chunk.
};

Sample make_sample() {
  Sample sample{test::sample_file(300, {16'384, 200'000'000, 1}), {}, {}};
  const auto source = source_of(sample.bytes);
  const McapScan scan = scan_mcap(*source).value();
  for (const McapScan::Chunk& chunk : scan.chunks) sample.chunks.emplace_back(chunk.info.offset, chunk.info.offset + chunk.info.length + chunk.info.index_length);
  sample.messages.resize(sample.chunks.size());
  auto reader = McapReader::open(source_of(sample.bytes), "sample").value();
  const auto refs = reader.messages(test::any_channel).value();
  for (const McapMessageRef& ref : refs) sample.messages[ref.chunk].push_back(reader.read(ref)->sequence);
  return sample;
}

/// One bit: at most the messages of its chunk are gone.
Trial flip_trial(std::uint64_t seed) {
  static const Sample kSample = make_sample();
  Random random(seed);
  const auto at = static_cast<std::size_t>(random.next() % kSample.bytes.size());
  std::string bytes = kSample.bytes;
  bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
  const auto found = test::all_messages(bytes);
  Trial trial;
  for (const auto& [i, message] : found)
    if (!(message == test::sample_message(i))) trial.failure = "message " + std::to_string(i) + " is damaged";
  std::uint64_t lost = 0;
  for (std::size_t chunk = 0; chunk < kSample.chunks.size(); ++chunk) {
    const bool is_hit = at >= kSample.chunks[chunk].first && at < kSample.chunks[chunk].second;
    for (const std::uint32_t i : kSample.messages[chunk]) {
      if (found.contains(i)) continue;
      ++lost;
      if (!is_hit) trial.failure = "message " + std::to_string(i) + " of a sound chunk is gone";
    }
  }
  if (!trial.failure.empty()) trial.failure += ", byte " + std::to_string(at);
  trial.measured("lost_messages_max", lost);
  return trial;
}

/// A disk in memory whose write number `fail_at` (and a few behind it) is refused.
class FailingStorage final : public RecordingStorage {
 public:
  explicit FailingStorage(std::size_t from, std::size_t until) : from_(from), until_(until) {}
  std::vector<std::shared_ptr<test::MemoryFile::State>> files;

  Result<std::unique_ptr<ByteFile>> create(const std::filesystem::path&) override {
    const std::size_t writes = files.empty() ? 0 : files.back()->writes;
    files.push_back(std::make_shared<test::MemoryFile::State>());
    files.back()->writes = writes;
    files.back()->fail_from = from_;
    files.back()->fail_until = until_;
    return std::unique_ptr<ByteFile>(std::make_unique<test::MemoryFile>(files.back()));
  }
  Result<void> rename(const std::filesystem::path&, const std::filesystem::path&) override { return {}; }
  Result<void> remove(const std::filesystem::path&) override { return {}; }
  std::vector<std::filesystem::path> closed_files(const std::filesystem::path&, const std::string&) override { return {}; }
  Result<std::uint64_t> free_bytes(const std::filesystem::path&) override { return 1ULL << 40U; }

 private:
  std::size_t from_, until_;
};

/// Short messages, 10 ms apart, to the end of the recording.
void record(RecordingSeries& series, std::uint32_t messages) {
  Nanoseconds now{};
  for (std::uint32_t i = 0; i < messages; ++i) {
    McapMessage message = test::as_message(test::sample_message(i % kSamples), i);
    message.log_time_ns = 1'000'000'000ULL + 10'000'000ULL * i;
    message.data = message.data.substr(0, 100);
    series.put(kSpecs[i % 3], message, now += Nanoseconds(10'000'000));
    series.tick(now);
  }
  series.close();
}

/// Writes from `number` + 1 on are refused, `refused` of them: every message is in a file that is right, or counted as lost, which those
/// are that came while the disk refused.
Trial refusal_trial(std::uint64_t number, std::uint64_t refused) {
  FailingStorage storage(number + 1, number + 1 + refused);
  RecordingOptions options;
  options.mode = "continuous";
  options.max_file_mb = 1;
  RecordingSeries series(options, storage);
  constexpr std::uint32_t kMessages = 11'000;  // 20 a chunk: 550 writes and the ends of files
  record(series, kMessages);
  Trial trial;
  std::uint64_t found = 0;
  for (const auto& file : storage.files) {
    if (file->bytes.size() < 100) continue;  // it could not even be begun
    for (const auto& [i, message] : test::all_messages(file->bytes)) {
      if (message.data != test::sample_message(i % kSamples).data.substr(0, 100)) trial.failure = "message " + std::to_string(i) + " is damaged";
      ++found;
    }
  }
  if (found + series.status().lost_messages != kMessages) trial.failure = "of " + std::to_string(kMessages) + " messages " + std::to_string(found) + " are there and " + std::to_string(series.status().lost_messages) + " counted as lost";
  if (series.status().write_errors == 0) trial.failure = "the refused write was not counted";
  if (series.status().lost_messages > 21 * refused) trial.failure = std::to_string(series.status().lost_messages) + " messages lost by " + std::to_string(refused) + " refused writes";
  trial.measured("lost_messages_max", series.status().lost_messages);
  return trial;
}

/// EIO: one write. ENOSPC: all of them for 5 s, which are 25 chunks.
Trial write_trial(std::uint64_t number) { return refusal_trial(number, 1); }
Trial space_trial(std::uint64_t number) { return refusal_trial(number, 25); }

/// What a recording asked of its disk, in order.
struct DiskEvent {
  enum class Kind { kWrite, kTruncate, kSync } kind = Kind::kWrite;
  std::uint64_t offset = 0;  ///< Of a write; of kTruncate the size.
  std::string bytes;
  std::uint64_t messages = 0;  ///< Of kSync: in the chunks that were written before it.
};

class TracedFile final : public ByteFile {
 public:
  TracedFile(std::vector<DiskEvent>& events, const std::function<std::uint64_t()>& messages) : events_(events), messages_(messages) {}
  Result<void> write_at(std::uint64_t offset, std::string_view bytes) override { return events_.push_back({DiskEvent::Kind::kWrite, offset, std::string(bytes), 0}), Result<void>{}; }
  Result<void> truncate(std::uint64_t size) override { return events_.push_back({DiskEvent::Kind::kTruncate, size, {}, 0}), Result<void>{}; }
  Result<void> sync() override { return events_.push_back({DiskEvent::Kind::kSync, 0, {}, messages_()}), Result<void>{}; }

 private:
  std::vector<DiskEvent>& events_;
  const std::function<std::uint64_t()>& messages_;
};

class TracingStorage final : public RecordingStorage {
 public:
  std::vector<DiskEvent> events;
  std::function<std::uint64_t()> messages;
  Result<std::unique_ptr<ByteFile>> create(const std::filesystem::path&) override { return std::unique_ptr<ByteFile>(std::make_unique<TracedFile>(events, messages)); }
  Result<void> rename(const std::filesystem::path&, const std::filesystem::path&) override { return {}; }
  Result<void> remove(const std::filesystem::path&) override { return {}; }
  std::vector<std::filesystem::path> closed_files(const std::filesystem::path&, const std::string&) override { return {}; }
  Result<std::uint64_t> free_bytes(const std::filesystem::path&) override { return 1ULL << 40U; }
};

/// One file of a minute: chunks of 200 ms, synchronised every 800 ms, and its end.
std::vector<DiskEvent> make_trace() {
  TracingStorage storage;
  RecordingOptions options;
  options.mode = "continuous";
  RecordingSeries series(options, storage);
  storage.messages = [&] { return series.status().messages; };
  record(series, 6000);
  return storage.events;
}

void carry_out(const DiskEvent& event, std::string& disk) {
  if (event.kind == DiskEvent::Kind::kSync) return;
  if (event.kind == DiskEvent::Kind::kTruncate) return disk.resize(static_cast<std::size_t>(event.offset));
  disk.resize(std::max<std::size_t>(disk.size(), static_cast<std::size_t>(event.offset) + event.bytes.size()));
  std::copy(event.bytes.begin(), event.bytes.end(), disk.begin() + static_cast<std::ptrdiff_t>(event.offset));
}

/// A write of which only some sectors have come to the disk: the others are as they were, or zeros.
DiskEvent torn(DiskEvent event, const std::string& disk, Random& random) {
  constexpr std::uint64_t kSector = 512;
  for (std::uint64_t at = 0; at < event.bytes.size();) {
    const std::uint64_t end = std::min<std::uint64_t>(event.bytes.size(), at + kSector - (event.offset + at) % kSector);
    if (random.below(2) == 0)
      for (; at < end; ++at) event.bytes[at] = event.offset + at < disk.size() ? disk[event.offset + at] : '\0';
    at = end;
  }
  return event;
}

/// Power goes after a number of the recording's requests: what was synchronised is on the disk; of what came after it each write is there,
/// torn or not there, in any order. What was synchronised is all found again, and nothing else is other than it was.
Trial power_trial(std::uint64_t seed) {
  static const std::vector<DiskEvent> kTrace = make_trace();
  Random random(seed);
  const std::size_t prefix = seed % (kTrace.size() + 1);  // every one of them, again and again
  std::string disk;
  std::vector<const DiskEvent*> loose;
  std::uint64_t durable = 0;
  for (std::size_t i = 0; i < prefix; ++i) {
    loose.push_back(&kTrace[i]);
    if (kTrace[i].kind != DiskEvent::Kind::kSync) continue;
    for (const DiskEvent* event : loose) carry_out(*event, disk);
    loose.clear();
    durable = kTrace[i].messages;
  }
  for (std::size_t i = loose.size(); i > 1; --i) std::swap(loose[i - 1], loose[random.below(static_cast<std::uint32_t>(i))]);
  for (const DiskEvent* event : loose) {
    const auto fate = random.below(3);
    if (fate == 0) carry_out(*event, disk);
    if (fate == 1) carry_out(event->kind == DiskEvent::Kind::kWrite ? torn(*event, disk, random) : *event, disk);
  }
  const test::TemporaryFolder folder;
  const auto file = folder.write("gfp_1.mcap", disk);
  Trial trial;
  const auto repaired = repair_mcap(file);
  if (!repaired && durable > 0) trial.failure = "not repaired: " + repaired.error().what;
  const auto found = repaired ? read_folder(folder.path(), trial.failure, 100) : std::map<std::uint32_t, bool>();
  for (std::uint32_t i = 0; i < durable; ++i)
    if (!found.contains(i)) trial.failure = "message " + std::to_string(i) + " of " + std::to_string(durable) + " that were synchronised is gone";
  if (!trial.failure.empty()) trial.failure += ", power lost after " + std::to_string(prefix) + " of " + std::to_string(kTrace.size()) + " requests";
  trial.measured("messages_max", found.size());
  trial.measured("unsynchronised_writes_max", loose.size());
  return trial;
}

}  // namespace
}  // namespace gfp

int main(int argc, char** argv) {
  std::string ledger;
  std::uint64_t kills = 0, flips = 0, writes = 0, spaces = 0, powers = 0;
  CLI::App app{"Kills, rotten bits, refused writes and power losses of recordings", "gfp_recording_soak"};
  app.add_option("LEDGER", ledger, "Where results go, and where a run goes on")->required();
  app.add_option("--kills", kills);
  app.add_option("--flips", flips);
  app.add_option("--writes", writes);
  app.add_option("--spaces", spaces);
  app.add_option("--powers", powers);
  CLI11_PARSE(app, argc, argv);
  const gfp::test::SoakLedger soak(ledger);
  const bool sound = soak.run("kill", kills, gfp::kill_trial) && soak.run("flip", flips, gfp::flip_trial) && soak.run("write", writes, gfp::write_trial) &&
                     soak.run("space", spaces, gfp::space_trial) && soak.run("power", powers, gfp::power_trial);
  return sound ? 0 : 1;
}
