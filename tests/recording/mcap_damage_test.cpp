// What a kill, a full disk or a rotten disk leaves of a recording: everything but the chunk that was hit.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "gfp/recording/repair.hpp"
#include "recording/sample_recording.hpp"
#include "support/mutate.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using test::all_messages;
using test::sample_file;
using test::sample_message;

constexpr std::uint32_t kCount = 120;

/// Bytes [begin, end) of each chunk record with its indices, and the messages it holds.
struct ChunkPlace {
  std::uint64_t begin = 0, end = 0;
  std::vector<std::uint32_t> messages;
};

std::vector<ChunkPlace> places_of(const std::string& bytes) {
  const auto source = source_of(bytes);
  const McapScan scan = scan_mcap(*source).value();
  auto reader = McapReader::open(source_of(bytes), "sample").value();
  std::vector<ChunkPlace> places;
  for (const McapScan::Chunk& chunk : scan.chunks) places.push_back({chunk.info.offset, chunk.info.offset + chunk.info.length + chunk.info.index_length, {}});
  const auto refs = reader.messages(test::any_channel).value();
  for (const McapMessageRef& ref : refs) places[ref.chunk].messages.push_back(reader.read(ref)->sequence);
  return places;
}

/// All samples are there but those of `lost`, and none is other than it was.
void expect_all_but(const std::map<std::uint32_t, test::SampleMessage>& found, const std::vector<std::uint32_t>& lost, const std::string& what) {
  for (const auto& [i, message] : found) ASSERT_EQ(message, sample_message(i)) << what << ", message " << i;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const bool may_be_gone = std::find(lost.begin(), lost.end(), i) != lost.end();
    ASSERT_TRUE(may_be_gone || found.contains(i)) << what << ", message " << i;
  }
}

TEST(McapDamage, AFlippedBitCostsItsChunkAtMost) {
  const std::string sound = sample_file(kCount);
  const std::vector<ChunkPlace> places = places_of(sound);
  ASSERT_GT(places.size(), 5U);
  const test::TemporaryFolder folder;
  Random random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const auto at = static_cast<std::size_t>(random.next() % sound.size());
    const int bit = random.below(8);
    std::string bytes = sound;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
    std::vector<std::uint32_t> lost;
    for (const ChunkPlace& place : places)
      if (at >= place.begin && at < place.end) lost = place.messages;
    const std::string what = "bit " + std::to_string(bit) + " of byte " + std::to_string(at);
    expect_all_but(all_messages(bytes), lost, what);
    if (trial % 10 != 0) continue;
    const auto file = folder.write("flipped.mcap", bytes);
    const auto report = repair_mcap(file);
    ASSERT_TRUE(report) << what << ": " << report.error().what;
    auto repaired = McapReader::open(file);
    ASSERT_TRUE(repaired) << what;
    ASSERT_TRUE(repaired->has_index() || report->outcome == RepairReport::Outcome::kSound) << what;
    expect_all_but(all_messages(*repaired), lost, what + ", repaired");
  }
}

// Every length that a kill may leave: all whole chunks are read, and repair closes the file.
TEST(McapDamage, AFileThatWasCutKeepsItsWholeChunks) {
  const std::string sound = sample_file(kCount);
  const std::vector<ChunkPlace> places = places_of(sound);
  const test::TemporaryFolder folder;
  Random random(8);
  const auto source = source_of(sound);
  const McapScan scan = scan_mcap(*source).value();
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t size = static_cast<std::size_t>(scan.chunks[0].info.offset + scan.chunks[0].info.length) + static_cast<std::size_t>(random.next() % (sound.size() - scan.chunks[1].info.offset));
    std::vector<std::uint32_t> lost;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (scan.chunks[i].info.offset + scan.chunks[i].info.length > size) lost.insert(lost.end(), places[i].messages.begin(), places[i].messages.end());
    const auto file = folder.write("cut.mcap", sound.substr(0, size));
    const auto report = repair_mcap(file);
    ASSERT_TRUE(report) << size << ": " << report.error().what;
    EXPECT_NE(report->outcome, RepairReport::Outcome::kLost) << size;
    auto repaired = McapReader::open(file);
    ASSERT_TRUE(repaired && repaired->has_index()) << size;
    const auto found = all_messages(*repaired);
    expect_all_but(found, lost, "cut to " + std::to_string(size));
    EXPECT_EQ(found.size(), kCount - lost.size());
    EXPECT_EQ(repair_mcap(file)->outcome, RepairReport::Outcome::kSound) << "repaired twice";
  }
}

TEST(McapDamage, RepairNamesWhatIsLost) {
  std::string bytes = sample_file(kCount);
  const std::vector<ChunkPlace> places = places_of(bytes);
  bytes[static_cast<std::size_t>(places[3].begin) + 60] ^= 1;
  const test::TemporaryFolder folder;
  const auto file = folder.write("rotten.mcap", bytes);
  const auto report = repair_mcap_to(file, folder / "out.mcap");
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->outcome, RepairReport::Outcome::kLost);
  ASSERT_EQ(report->damage.size(), 1U);
  EXPECT_EQ(report->damage[0].begin, places[3].begin);
  EXPECT_GT(report->damage[0].end, report->damage[0].begin + 100) << "the chunk's record";
  EXPECT_LE(report->damage[0].end, places[4].begin) << "and none of the next";
  EXPECT_EQ(report->messages, kCount - places[3].messages.size());
  EXPECT_EQ(repair_mcap_to(file, folder / "out.mcap").error().code, ErrorCode::kInvalidArgument) << "never over another file";
  EXPECT_EQ(repair_mcap(file)->outcome, RepairReport::Outcome::kLost);
  EXPECT_EQ(repair_mcap(file)->outcome, RepairReport::Outcome::kSound);
}

// Whatever the bytes, an error or messages that are right; the file that is repaired is readable.
/// A file with metadata before, between and behind its chunks; without its end where it was cut.
std::string file_with_metadata(bool is_cut) {
  const auto state = std::make_shared<test::MemoryFile::State>();
  McapEncoder encoder({16'384, 200'000'000, 1});
  test::add_sample_channels(encoder);
  McapWriter writer = McapWriter::begin(std::make_unique<test::MemoryFile>(state)).value();
  EXPECT_TRUE(writer.append_metadata("robot", {{"name", "tidy"}, {"arm", "left"}}));
  for (std::uint32_t i = 0; i < 40; ++i)
    if (const auto chunk = encoder.add(test::as_message(sample_message(i), i)).value()) {
      EXPECT_TRUE(writer.append(*chunk));
      EXPECT_TRUE(writer.append_metadata("chunk " + std::to_string(i), {}));
    }
  if (!is_cut) {
    EXPECT_TRUE(writer.finish(encoder.registry()));
  }
  return state->bytes;
}

TEST(McapDamage, RepairKeepsMetadata) {
  const test::TemporaryFolder folder;
  const auto names = [](const std::string& bytes) {
    const auto source = source_of(bytes);
    const McapScan scan = scan_mcap(*source).value();
    std::vector<std::string> found;
    for (const McapMetadata& one : scan.metadata) found.push_back(one.name);
    return found;
  };
  const auto read = [](const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string whole = file_with_metadata(false);
  const auto expected = names(whole);
  ASSERT_GT(expected.size(), 3U);
  EXPECT_EQ(repair_mcap(folder.write("whole.mcap", whole))->outcome, RepairReport::Outcome::kSound);
  const auto cut = folder.write("cut.mcap", file_with_metadata(true));
  EXPECT_EQ(repair_mcap(cut)->outcome, RepairReport::Outcome::kClosed) << "closed in place";
  std::string rotten = whole;
  const auto hit = places_of(whole).at(1);
  for (std::uint64_t at = hit.begin + 100; at < hit.begin + 110; ++at) rotten[at] = static_cast<char>(~rotten[at]);
  const auto copied = folder.write("rotten.mcap", rotten);
  EXPECT_EQ(repair_mcap(copied)->outcome, RepairReport::Outcome::kLost) << "copied";
  for (const auto& file : {cut, copied}) {
    const std::string bytes = read(file);
    EXPECT_EQ(names(bytes), expected) << file;
    const auto source = source_of(bytes);
    const McapScan scan = scan_mcap(*source).value();
    EXPECT_EQ(scan.metadata.at(0).values, (std::map<std::string, std::string>{{"arm", "left"}, {"name", "tidy"}}));
    EXPECT_EQ(repair_mcap(file)->outcome, RepairReport::Outcome::kSound) << "its summary is right: " << file;
  }
}

TEST(McapDamage, SurvivesHostileBytes) {
  const std::string sound = sample_file(40);
  const test::TemporaryFolder folder;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const std::string bytes = test::mutated(sound, seed, sound.size());
    const auto found = all_messages(bytes);
    for (const auto& [i, message] : found) ASSERT_EQ(message, sample_message(i)) << "seed " << seed;
    if (seed % 10 != 0) continue;
    const auto file = folder.write("hostile.mcap", bytes);
    if (const auto report = repair_mcap(file)) {
      auto repaired = McapReader::open(file);
      ASSERT_TRUE(repaired) << "seed " << seed;
      EXPECT_GE(all_messages(*repaired).size(), found.size()) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace gfp
