#include "gfp/recording/recording_file.hpp"

#include <fmt/format.h>

namespace gfp {

Result<RecordingFile> RecordingFile::create(const std::filesystem::path& file, const McapEncoderOptions& options) {
  auto out = create_file(file.string() + ".active");
  if (!out) return tl::unexpected(out.error());
  auto writer = McapWriter::begin(std::move(*out));
  if (!writer) return tl::unexpected(writer.error());
  return RecordingFile(file, std::move(*writer), options);
}

Result<void> RecordingFile::put(const McapChannelSpec& spec, McapMessage message) {
  auto channel = channels_.find(spec.topic);
  if (channel == channels_.end()) {
    const auto added = encoder_.add_channel(spec);
    if (!added) return tl::unexpected(added.error());
    channel = channels_.emplace(spec.topic, *added).first;
  }
  message.channel = channel->second;
  const auto chunk = encoder_.add(message);
  if (!chunk) return tl::unexpected(chunk.error());
  return *chunk ? writer_.append(**chunk) : Result<void>();
}

Result<void> RecordingFile::flush() {
  const auto chunk = encoder_.flush();
  if (!chunk) return tl::unexpected(chunk.error());
  if (*chunk) {
    if (auto written = writer_.append(**chunk); !written) return written;
  }
  return writer_.sync();
}

Result<void> RecordingFile::finish() {
  if (auto flushed = flush(); !flushed) return flushed;
  if (auto finished = writer_.finish(encoder_.registry()); !finished) return finished;
  std::error_code error;
  std::filesystem::rename(file_.string() + ".active", file_, error);
  if (error) return failure(ErrorCode::kIo, fmt::format("{}: {}", file_.string(), error.message()));
  return {};
}

}  // namespace gfp
