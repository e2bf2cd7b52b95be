#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gfp/recording/mcap_scan.hpp"

namespace gfp {

/// Reads any MCAP file (zstd, lz4 or no compression, with chunks or without) message by message, through its index where it has a
/// sound one, else after a walk through the whole file (scan_mcap()). Bytes that are damaged cost what they hold. One thread at a time.
class McapReader {
 public:
  /// Errors: kNotFound, kIo; as scan_mcap(). They name the file.
  static Result<McapReader> open(const std::filesystem::path& path, const McapReadOptions& options = {});
  /// `name` is what errors name.
  static Result<McapReader> open(std::unique_ptr<ByteSource> source, std::string name, const McapReadOptions& options = {});

  const McapRegistry& registry() const { return registry_; }
  const McapSchema* schema_of(const McapChannel& channel) const;  ///< nullptr: it has none.
  const std::vector<McapDamage>& damage() const { return damage_; }  ///< Of what was read so far.
  bool has_index() const { return has_index_; }                  ///< False: the file was not closed, or its summary is damaged.

  /// All messages of the channels that `wanted` wants, by log time; those of one time in the order of the file.
  /// Errors: kTooLarge (more than the options allow), kIo. A chunk that cannot be read is left out and noted as damage.
  Result<std::vector<McapMessageRef>> messages(const std::function<bool(const McapChannel&)>& wanted);

  /// One message; its data live until the next call. Errors: kCorruptData, kTooLarge, kUnsupported, kIo.
  Result<McapMessage> read(const McapMessageRef& ref);

 private:
  McapReader(std::unique_ptr<ByteSource> source, std::string name, const McapReadOptions& options)
      : source_(std::move(source)), name_(std::move(name)), options_(options) {}

  bool read_summary();
  Result<const std::string*> chunk_records(std::uint32_t chunk);
  Result<void> add_indexed(std::uint32_t chunk, std::vector<McapMessageRef>& all);
  bool add_from_index(std::uint32_t chunk, std::vector<McapMessageRef>& all);

  std::unique_ptr<ByteSource> source_;
  std::string name_;
  McapReadOptions options_;
  McapRegistry registry_;
  std::vector<McapChunkInfo> chunks_;
  std::vector<McapMessageRef> scanned_;   ///< Where there is no index.
  std::vector<McapDamage> damage_;
  bool has_index_ = false;
  std::deque<std::pair<std::uint32_t, std::string>> cache_;  ///< Chunks that were read last, uncompressed; newest first.
  std::string buffer_;
};

}  // namespace gfp
