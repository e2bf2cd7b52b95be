#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gfp/core/random.hpp"
#include "gfp/recording/mcap_reader.hpp"
#include "gfp/recording/mcap_writer.hpp"

namespace gfp::test {

/// A file in memory that may be told to fail.
class MemoryFile final : public ByteFile {
 public:
  struct State {
    std::string bytes;
    std::size_t writes = 0, syncs = 0;
    std::size_t fail_from = 0, fail_until = 0;  ///< Writes [from, until), counted from 1, fail half-way.
    std::size_t capacity = std::string::npos;   ///< Of its disk: beyond it nothing is written.
  };
  explicit MemoryFile(std::shared_ptr<State> state) : state_(std::move(state)) {}

  Result<void> write_at(std::uint64_t offset, std::string_view bytes) override {
    ++state_->writes;
    const bool is_full = offset + bytes.size() > std::max(state_->capacity, state_->bytes.size());
    const bool fails = is_full || (state_->writes >= state_->fail_from && state_->writes < state_->fail_until);
    if (is_full) bytes = bytes.substr(0, state_->capacity - std::min<std::size_t>(state_->capacity, static_cast<std::size_t>(offset)));
    else if (fails) bytes = bytes.substr(0, bytes.size() / 2);
    if (state_->bytes.size() < offset + bytes.size()) state_->bytes.resize(offset + bytes.size());
    std::copy(bytes.begin(), bytes.end(), state_->bytes.begin() + static_cast<std::ptrdiff_t>(offset));
    if (fails) return failure(ErrorCode::kIo, "No space left on device");
    return {};
  }
  Result<void> truncate(std::uint64_t size) override { return state_->bytes.resize(size), Result<void>{}; }
  Result<void> sync() override { return ++state_->syncs, Result<void>{}; }

 private:
  std::shared_ptr<State> state_;
};

/// Message number `i` of the samples: of one of three channels, of 0 to 4000 bytes, 10 ms after the one before.
struct SampleMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time_ns = 0;
  std::string data;
  friend bool operator==(const SampleMessage&, const SampleMessage&) = default;
};

inline SampleMessage make_sample(std::uint32_t i) {
  Random random(i + 1);
  SampleMessage message{static_cast<std::uint16_t>(1 + i % 3), 1'000'000'000ULL + 10'000'000ULL * i, {}};
  message.data.resize(static_cast<std::size_t>(random.below(4000)));
  for (char& byte : message.data) byte = static_cast<char>(random.below(16));
  return message;
}

inline const SampleMessage& sample_message(std::uint32_t i) {
  static std::vector<SampleMessage> made;
  while (made.size() <= i) made.push_back(make_sample(static_cast<std::uint32_t>(made.size())));
  return made[i];
}

inline void add_sample_channels(McapEncoder& encoder) {
  for (const char* name : {"one", "two", "three"})
    encoder.add_channel({std::string("/") + name + "/", "test", std::string("schema_") + name, "text", std::string(300, name[0]), {{"key", name}}}).value();
}

inline McapMessage as_message(const SampleMessage& sample, std::uint32_t i) {
  return {sample.channel, i, sample.log_time_ns, sample.log_time_ns + 1, sample.data};
}

/// A closed file of `count` samples.
inline std::string sample_file(std::uint32_t count, const McapEncoderOptions& options = {16'384, 200'000'000, 1}) {
  const auto state = std::make_shared<MemoryFile::State>();
  McapEncoder encoder(options);
  add_sample_channels(encoder);
  McapWriter writer = McapWriter::begin(std::make_unique<MemoryFile>(state)).value();
  bool sound = true;
  for (std::uint32_t i = 0; i < count; ++i)
    if (const auto chunk = encoder.add(as_message(sample_message(i), i)).value()) sound = sound && writer.append(*chunk);
  if (const auto chunk = encoder.flush().value()) sound = sound && writer.append(*chunk);
  EXPECT_TRUE(sound && writer.finish(encoder.registry()));
  return state->bytes;
}

inline bool any_channel(const McapChannel&) { return true; }

/// Everything that a reader gives, by message number; messages that cannot be read are left out.
inline std::map<std::uint32_t, SampleMessage> all_messages(McapReader& reader) {
  std::map<std::uint32_t, SampleMessage> found;
  const auto refs = reader.messages(any_channel);
  if (!refs) return found;
  for (const McapMessageRef& ref : *refs)
    if (const auto message = reader.read(ref)) found[message->sequence] = {message->channel, message->log_time_ns, std::string(message->data)};
  return found;
}

inline std::map<std::uint32_t, SampleMessage> all_messages(const std::string& bytes) {
  auto reader = McapReader::open(source_of(bytes), "sample");
  return reader ? all_messages(*reader) : std::map<std::uint32_t, SampleMessage>{};
}

}  // namespace gfp::test
