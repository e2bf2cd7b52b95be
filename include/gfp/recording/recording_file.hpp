#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "gfp/recording/mcap_writer.hpp"

namespace gfp {

/// One recording under a name of the caller's choice, `<name>.active` until it is finished. One thread at a time.
class RecordingFile {
 public:
  /// Errors: kIo.
  static Result<RecordingFile> create(const std::filesystem::path& file, const McapEncoderOptions& options = {});

  /// Takes in one message of the channel that `spec` describes; `message.channel` is set here. Errors: kIo, kTooLarge.
  Result<void> put(const McapChannelSpec& spec, McapMessage message);
  Result<void> flush();   ///< What waits for its chunk goes to the disk. Errors: kIo.
  Result<void> finish();  ///< Closes the file and gives it its name. Errors: kIo.

  std::uint64_t messages() const { return writer_.messages() + encoder_.waiting_messages(); }
  std::uint64_t bytes() const { return writer_.bytes(); }

 private:
  RecordingFile(std::filesystem::path file, McapWriter writer, const McapEncoderOptions& options)
      : file_(std::move(file)), writer_(std::move(writer)), encoder_(options) {}

  std::filesystem::path file_;
  McapWriter writer_;
  McapEncoder encoder_;
  std::map<std::string, std::uint16_t> channels_;  ///< By topic.
};

}  // namespace gfp
