// A file that is written and read again says the same, in every way that it can be written and read.
#include <gtest/gtest.h>

#include "gfp/recording/mcap_scan.hpp"
#include "gfp/recording/repair.hpp"
#include "recording/little_endian.hpp"
#include "recording/mcap_layout.hpp"
#include "recording/sample_recording.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using test::all_messages;
using test::sample_file;
using test::sample_message;

void expect_samples(const std::map<std::uint32_t, test::SampleMessage>& found, std::uint32_t count) {
  ASSERT_EQ(found.size(), count);
  for (const auto& [i, message] : found) ASSERT_EQ(message, sample_message(i)) << "message " << i;
}

TEST(McapFile, GivesBackWhatWasWritten) {
  for (const std::uint32_t count : {1U, 2U, 500U})
    for (const int level : {0, 1, 3}) expect_samples(all_messages(sample_file(count, {16'384, 200'000'000, level})), count);
}

TEST(McapFile, IsTheSameBytesEveryTime) { EXPECT_EQ(sample_file(300), sample_file(300)); }

TEST(McapFile, HasAnIndexWithDefinitions) {
  auto reader = McapReader::open(source_of(sample_file(50)), "sample");
  ASSERT_TRUE(reader) << reader.error().what;
  EXPECT_TRUE(reader->has_index());
  ASSERT_EQ(reader->registry().channels.size(), 3U);
  const McapChannel& channel = reader->registry().channels.at(2);
  EXPECT_EQ(channel.topic, "/two/");
  EXPECT_EQ(channel.metadata.at("key"), "two");
  ASSERT_NE(reader->schema_of(channel), nullptr);
  EXPECT_EQ(reader->schema_of(channel)->data, std::string(300, 't'));
}

// The chunks' indices name every message; asking for one channel reads no other's.
TEST(McapFile, GivesOneChannelInOrderOfTime) {
  auto reader = McapReader::open(source_of(sample_file(300)), "sample");
  ASSERT_TRUE(reader);
  const auto refs = reader->messages([](const McapChannel& channel) { return channel.topic == "/three/"; });
  ASSERT_TRUE(refs);
  ASSERT_EQ(refs->size(), 100U);
  EXPECT_TRUE(std::is_sorted(refs->begin(), refs->end(), [](const auto& a, const auto& b) { return a.log_time_ns < b.log_time_ns; }));
  for (const McapMessageRef& ref : *refs) EXPECT_EQ(reader->read(ref)->channel, 3);
}

// A clock that was set back: times in the file fall, the reader's order is that of the times.
TEST(McapFile, TakesTimesInAnyOrder) {
  const auto state = std::make_shared<test::MemoryFile::State>();
  McapEncoder encoder({1024, 200'000'000, 1});
  test::add_sample_channels(encoder);
  McapWriter writer = McapWriter::begin(std::make_unique<test::MemoryFile>(state)).value();
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::string data(200, 'x');
    const auto chunk = encoder.add({1, i, 1000 - i, 0, data}).value();
    ASSERT_TRUE(!chunk || writer.append(*chunk));
  }
  const auto rest = encoder.flush().value();
  ASSERT_TRUE(!rest || writer.append(*rest));
  ASSERT_TRUE(writer.finish(encoder.registry()));
  auto reader = McapReader::open(source_of(state->bytes), "sample");
  ASSERT_TRUE(reader);
  const auto refs = reader->messages(test::any_channel).value();
  ASSERT_EQ(refs.size(), 60U);
  for (std::uint32_t i = 0; i < 60; ++i) EXPECT_EQ(reader->read(refs[i])->sequence, 59 - i);
}

TEST(McapFile, ChunksAreBoundedInBytesAndTime) {
  McapEncoder by_bytes({10'000, 1'000'000'000'000, 1}), by_time({1U << 30, 200'000'000, 1});
  for (McapEncoder* encoder : {&by_bytes, &by_time}) {
    test::add_sample_channels(*encoder);
    for (std::uint32_t i = 0; i < 300; ++i) {
      const auto chunk = encoder->add(test::as_message(sample_message(i), i)).value();
      if (!chunk) continue;
      if (encoder == &by_bytes) {
        EXPECT_LT(chunk->info.uncompressed_bytes, 10'000U + 4'000 + 1'500);  // one message and the definitions more
      } else {
        EXPECT_EQ(chunk->info.end_ns - chunk->info.start_ns, 200'000'000U);
      }
    }
  }
}

TEST(McapFile, EqualChannelsAreOne) {
  McapEncoder encoder;
  const McapChannelSpec spec{"/a/", "protobuf", "S", "protobuf", "bytes", {}};
  McapChannelSpec other = spec;
  other.topic = "/b/";
  EXPECT_EQ(encoder.add_channel(spec).value(), encoder.add_channel(spec).value());
  EXPECT_NE(encoder.add_channel(spec).value(), encoder.add_channel(other).value());
  EXPECT_EQ(encoder.registry().schemas.size(), 1U);
  EXPECT_EQ(encoder.add({77, 0, 0, 0, ""}).error().code, ErrorCode::kInvalidArgument);
}

// rosbag2's `fastwrite`: messages on their own, no chunk, no index. Repair puts them into chunks.
TEST(McapFile, ReadsMessagesWithoutChunks) {
  std::string bytes(mcap::kMagic);
  mcap::put_header(bytes, "other");
  mcap::put_schema(bytes, {1, "s", "text", "?"});
  for (std::uint16_t id : {1, 2, 3}) mcap::put_channel(bytes, {id, 1, "/topic/" + std::to_string(id), "test", {}});
  for (std::uint32_t i = 0; i < 20; ++i) {
    const auto sample = sample_message(i);
    mcap::put_record(bytes, mcap::Op::kMessage, [&] {
      BytePut put(bytes);
      put.number(sample.channel);
      put.number(i);
      put.number(sample.log_time_ns);
      put.number(sample.log_time_ns);
      bytes += sample.data;
    });
  }
  auto reader = McapReader::open(source_of(bytes), "loose");
  ASSERT_TRUE(reader) << reader.error().what;
  EXPECT_FALSE(reader->has_index());
  expect_samples(all_messages(*reader), 20);

  const test::TemporaryFolder folder;
  const auto file = folder.write("loose.mcap", bytes);
  const auto report = repair_mcap(file);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->messages, 20U);
  auto repaired = McapReader::open(file);
  ASSERT_TRUE(repaired);
  EXPECT_TRUE(repaired->has_index());
  expect_samples(all_messages(*repaired), 20);
}

TEST(McapFile, RefusesWhatIsNone) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(McapReader::open(folder / "missing.mcap").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(McapReader::open(folder.path()).error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(McapReader::open(folder.write("text.mcap", "hello, this is text")).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(McapReader::open(folder.write("empty.mcap", "")).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(repair_mcap(folder / "empty.mcap").error().code, ErrorCode::kCorruptData);
}

// More than the options allow is refused before it is unpacked.
TEST(McapFile, RefusesChunksBeyondTheBound) {
  const std::string bytes = sample_file(100, {65'536, 10'000'000'000, 1});
  McapReadOptions options;
  options.max_chunk_bytes = 20'000;
  auto reader = McapReader::open(source_of(bytes), "sample", options);
  ASSERT_TRUE(reader);
  const auto refs = reader->messages(test::any_channel).value();
  ASSERT_FALSE(refs.empty());
  EXPECT_EQ(reader->read(refs.front()).error().code, ErrorCode::kTooLarge);
  options.max_messages = 50;
  EXPECT_EQ(reader->open(source_of(bytes), "sample", options)->messages(test::any_channel).error().code, ErrorCode::kTooLarge);
}

}  // namespace
}  // namespace gfp
