// A recording that goes on for long: files change, disks fill up and fail, rings wait for their trigger. Time is told, never waited for.
#include "gfp/recording/recording_series.hpp"

#include <gtest/gtest.h>

#include "recording/sample_recording.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::MemoryFile;

/// Files in memory, in the order in which they were begun; renamed and removed as told.
class MemoryStorage final : public RecordingStorage {
 public:
  struct File {
    std::filesystem::path name;
    std::shared_ptr<MemoryFile::State> state;
  };
  std::vector<File> files;
  std::uint64_t free = 1ULL << 40U;
  std::size_t fail_from = 0, fail_until = 0;  ///< Writes of every file.
  std::size_t capacity = std::string::npos;   ///< Of every file's disk.
  bool refuses_files = false;
  std::vector<std::filesystem::path> removed;

  Result<std::unique_ptr<ByteFile>> create(const std::filesystem::path& file) override {
    if (refuses_files) return failure(ErrorCode::kIo, "Read-only file system");
    std::size_t writes = 0;  // of all files: a disk that fails does so for all of them
    for (const File& earlier : files) writes = earlier.state->writes;
    files.push_back({file, std::make_shared<MemoryFile::State>()});
    files.back().state->writes = writes;
    files.back().state->fail_from = fail_from;
    files.back().state->fail_until = fail_until;
    files.back().state->capacity = capacity;
    return std::unique_ptr<ByteFile>(std::make_unique<MemoryFile>(files.back().state));
  }
  Result<void> rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    for (File& file : files)
      if (file.name == from) file.name = to;
    return {};
  }
  Result<void> remove(const std::filesystem::path& file) override {
    removed.push_back(file);
    free += 1'000'000'000;
    return {};
  }
  std::vector<std::filesystem::path> closed_files(const std::filesystem::path&, const std::string&) override { return {"a_1.mcap", "a_2.mcap", "a_3.mcap"}; }
  Result<std::uint64_t> free_bytes(const std::filesystem::path&) override { return free; }
};

const McapChannelSpec kSpecs[3] = {{"/one/", "test", "a", "text", "a", {}}, {"/two/", "test", "b", "text", "b", {}}, {"/three/", "test", "c", "text", "c", {}}};

struct Bench {
  MemoryStorage storage;
  RecordingOptions options;
  Nanoseconds now{1s};
  std::uint32_t next = 0;

  Bench() {
    options.mode = "continuous";
    options.min_free_mb = 10;
  }
  /// The next samples, 10 ms each.
  void put(RecordingSeries& series, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i, ++next) {
      now += 10ms;
      const auto& sample = test::sample_message(next);
      series.put(kSpecs[next % 3], test::as_message(sample, next), now);
      series.tick(now);
    }
  }
  std::map<std::uint32_t, test::SampleMessage> recorded() const {
    std::map<std::uint32_t, test::SampleMessage> all;
    for (const MemoryStorage::File& file : storage.files)
      for (const auto& [i, message] : test::all_messages(file.state->bytes)) all.insert_or_assign(i, message);
    return all;
  }
  void expect_true(const std::map<std::uint32_t, test::SampleMessage>& found) const {
    for (const auto& [i, message] : found) ASSERT_EQ(message.data, test::sample_message(i).data) << "message " << i;
  }
};

TEST(RecordingSeries, WritesEverythingAndNamesTheFileAtTheEnd) {
  Bench bench;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 300);
  ASSERT_EQ(bench.storage.files.size(), 1U);
  EXPECT_EQ(bench.storage.files[0].name, "recordings/gfp_19700101T000001.000Z.mcap.active");
  EXPECT_EQ(series.status().state, RecordingStatus::State::kRecording);
  series.close();
  EXPECT_EQ(bench.storage.files[0].name, "recordings/gfp_19700101T000001.000Z.mcap");
  const auto found = bench.recorded();
  EXPECT_EQ(found.size(), 300U);
  bench.expect_true(found);
  EXPECT_EQ(series.status().messages, 300U);
  EXPECT_EQ(series.status().files, 1U);
}

// What came more than 200 ms ago is in the file, what is older than a second is on the disk, even when nothing more comes.
TEST(RecordingSeries, HoldsNothingBackForLong) {
  Bench bench;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 7);
  EXPECT_TRUE(bench.recorded().empty()) << "7 messages in 70 ms wait for their chunk";
  bench.now += 200ms;
  series.tick(bench.now);
  EXPECT_EQ(bench.recorded().size(), 7U);
  EXPECT_EQ(bench.storage.files[0].state->syncs, 0U);
  bench.now += 800ms;
  series.tick(bench.now);
  EXPECT_EQ(bench.storage.files[0].state->syncs, 1U);
  bench.now += 10s;
  series.tick(bench.now);
  EXPECT_EQ(bench.storage.files[0].state->syncs, 1U) << "nothing new";
}

TEST(RecordingSeries, BeginsANewFileBySizeAndTime) {
  for (const bool by_size : {true, false}) {
    Bench bench;
    (by_size ? bench.options.max_file_mb : bench.options.max_file_s) = by_size ? 0.1 : 1.5;
    RecordingSeries series(bench.options, bench.storage);
    bench.put(series, 600);
    series.close();
    EXPECT_GE(bench.storage.files.size(), 3U);
    EXPECT_EQ(series.status().files, bench.storage.files.size());
    for (const MemoryStorage::File& file : bench.storage.files) {
      auto reader = McapReader::open(source_of(file.state->bytes), "file");
      ASSERT_TRUE(reader && reader->has_index());
      EXPECT_TRUE(!by_size || file.state->bytes.size() < 120'000U);  // the index comes on top
    }
    EXPECT_EQ(bench.recorded().size(), 600U);
  }
}

TEST(RecordingSeries, StopsWhereTheDiskIsFullAndGoesOnWhenItIsNot) {
  Bench bench;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 100);
  bench.storage.free = 1000;
  bench.put(series, 300);
  EXPECT_EQ(series.status().state, RecordingStatus::State::kNoSpace);
  EXPECT_EQ(series.status().files, 1U) << "what there was is closed and readable";
  const std::uint64_t lost = series.status().lost_messages;
  EXPECT_GT(lost, 0U);
  bench.storage.free = 1ULL << 40U;
  bench.put(series, 300);  // 3 s: it looks once a second
  EXPECT_EQ(series.status().state, RecordingStatus::State::kRecording);
  series.close();
  const auto found = bench.recorded();
  bench.expect_true(found);
  EXPECT_EQ(found.size() + series.status().lost_messages, 700U);
}

TEST(RecordingSeries, DeletesTheOldestWhereItIsTold) {
  Bench bench;
  bench.options.delete_oldest = true;
  bench.options.min_free_mb = 2000;
  bench.storage.free = 500'000'000;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 100);
  EXPECT_EQ(bench.storage.removed, (std::vector<std::filesystem::path>{"a_1.mcap", "a_2.mcap"}));
  EXPECT_EQ(series.status().lost_messages, 0U);
}

// ENOSPC or EIO at any write, once or for a while: the stream goes on, the file is closed and right, and only what was refused is gone.
TEST(RecordingSeries, ARefusedWriteCostsItsChunk) {
  for (std::size_t first = 1; first <= 40; ++first)
    for (const std::size_t length : {1U, 3U}) {
      Bench bench;
      bench.storage.fail_from = first;
      bench.storage.fail_until = first + length;
      RecordingSeries series(bench.options, bench.storage);
      bench.put(series, 500);
      series.close();
      const auto found = bench.recorded();
      bench.expect_true(found);
      EXPECT_EQ(found.size() + series.status().lost_messages, 500U) << "from write " << first;
      EXPECT_LE(series.status().lost_messages, 22 * (length + 1)) << "from write " << first;
      const bool failed = series.status().write_errors > 0;
      EXPECT_TRUE(failed || first > 25) << "from write " << first;
    }
}

// The disk is full to the last byte: the file is closed and right all the same, for the last chunks give their place to its end.
TEST(RecordingSeries, AFileOnAFullDiskIsClosed) {
  for (const std::size_t capacity : {100'000U, 100'500U, 131'072U, 200'001U}) {
    Bench bench;
    bench.options.min_free_mb = 0;
    bench.storage.capacity = capacity;
    RecordingSeries series(bench.options, bench.storage);
    bench.put(series, 500);
    EXPECT_EQ(series.status().state, RecordingStatus::State::kFailing);
    bench.storage.free = 0;
    series.close();
    ASSERT_EQ(bench.storage.files.size(), 1U);
    EXPECT_FALSE(bench.storage.files[0].name.string().ends_with(".active"));
    auto reader = McapReader::open(source_of(bench.storage.files[0].state->bytes), "full");
    ASSERT_TRUE(reader && reader->has_index()) << "capacity " << capacity;
    EXPECT_TRUE(reader->damage().empty());
    const auto found = bench.recorded();
    bench.expect_true(found);
    EXPECT_GT(found.size(), 0U);
    EXPECT_EQ(found.size(), series.status().messages);
    EXPECT_EQ(found.size() + series.status().lost_messages, 500U) << "capacity " << capacity;
  }
}

TEST(RecordingSeries, SurvivesAFolderThatCannotBeWritten) {
  Bench bench;
  bench.storage.refuses_files = true;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 100);
  EXPECT_EQ(series.status().state, RecordingStatus::State::kFailing);
  EXPECT_EQ(series.status().last_error, "Read-only file system");
  bench.storage.refuses_files = false;
  bench.put(series, 100);
  EXPECT_EQ(series.status().state, RecordingStatus::State::kRecording);
}

// A ring writes nothing until it is triggered; then what it held, and what came after.
TEST(RecordingSeries, ARingKeepsTheLastSecondsForItsTrigger) {
  Bench bench;
  bench.options.mode = "ring";
  bench.options.ring_s = 2;
  bench.options.after_trigger_s = 1;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 1000);
  EXPECT_TRUE(bench.storage.files.empty());
  series.trigger(bench.now);
  bench.put(series, 300);
  ASSERT_EQ(bench.storage.files.size(), 1U);
  EXPECT_FALSE(bench.storage.files[0].name.string().ends_with(".active")) << "closed a second after the trigger";
  const auto found = bench.recorded();
  bench.expect_true(found);
  ASSERT_FALSE(found.empty());
  EXPECT_LE(found.begin()->first, 1000U - 180) << "2 s less a chunk";
  EXPECT_GE(found.begin()->first, 1000U - 245);
  EXPECT_GE(found.rbegin()->first, 1000U + 95);
  EXPECT_LE(found.rbegin()->first, 1000U + 125);
  EXPECT_EQ(series.status().state, RecordingStatus::State::kIdle);
  series.close();
  EXPECT_EQ(bench.storage.files.size(), 1U);
}

TEST(RecordingSeries, ARingIsBoundedInBytes) {
  Bench bench;
  bench.options.mode = "ring";
  bench.options.ring_s = 3600;
  bench.options.ring_mb = 1;
  RecordingSeries series(bench.options, bench.storage);
  bench.put(series, 2000);
  series.trigger(bench.now);
  series.close();
  ASSERT_EQ(bench.storage.files.size(), 1U);
  EXPECT_LT(bench.storage.files[0].state->bytes.size(), 1'150'000U);
  EXPECT_GT(bench.storage.files[0].state->bytes.size(), 700'000U);
}

// On a real disk: what a kill left is closed by the next start.
TEST(RecordingSeries, RecoversWhatWasLeftOpen) {
  const test::TemporaryFolder folder;
  const auto storage = disk_storage();
  Bench bench;
  bench.options.folder = (folder / "recordings").string();
  {
    RecordingSeries series(bench.options, *storage);
    bench.put(series, 100);
    EXPECT_TRUE(recover_recordings(bench.options.folder, "gfp").empty()) << "it is still being written";
    std::filesystem::copy(folder / "recordings", folder / "killed");  // as if the process ended here
  }
  folder.write("killed/gfp_x.mcap.active", "not a recording");
  const auto recovered = recover_recordings(folder / "killed", "gfp");
  ASSERT_EQ(recovered.size(), 2U);
  EXPECT_TRUE(recovered[0].is_whole) << recovered[0].what;
  EXPECT_FALSE(recovered[1].is_whole);
  auto reader = McapReader::open(recovered[0].file);
  ASSERT_TRUE(reader && reader->has_index());
  const auto found = test::all_messages(*reader);
  EXPECT_GE(found.size(), 100U - 21);
  bench.expect_true(found);
}

}  // namespace
}  // namespace gfp
