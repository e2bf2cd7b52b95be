#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gfp/recording/byte_file.hpp"
#include "gfp/recording/mcap_encoder.hpp"

namespace gfp {

/// Writes one MCAP file out of chunks. Every call is one write; a failed one leaves the file as it was, so that the next chunk may
/// follow. What is on disk can be repaired at any time (repair_mcap()). One thread at a time.
class McapWriter {
 public:
  /// Writes the beginning of the file. Errors: of the file.
  static Result<McapWriter> begin(std::unique_ptr<ByteFile> file);
  struct MetadataEntry {
    std::uint64_t offset = 0, length = 0;
    std::string name;
  };
  /// Goes on behind the first `end` bytes of a file that has these chunks and metadata; what is behind them will be overwritten. For repair.
  static McapWriter resume(std::unique_ptr<ByteFile> file, std::uint64_t end, std::vector<McapChunkInfo> chunks, std::map<std::uint16_t, std::uint64_t> message_counts,
                           std::vector<MetadataEntry> metadata);

  Result<void> append(const McapChunk& chunk);
  Result<void> append_definitions(const McapRegistry& registry);  ///< Schemas and channels, for chunks that do not carry their own.
  Result<void> append_metadata(std::string_view name, const std::map<std::string, std::string>& values);
  Result<void> sync() { return file_->sync(); }

  /// Writes summary and end, cuts what a failed write may have left behind, and synchronises. `registry` is that of the chunks.
  /// An error leaves a file that can be repaired; finish() may be tried again.
  Result<void> finish(const McapRegistry& registry);

  /// Takes the last chunk back, where there is no room for the end of the file. Returns how many messages it held; 0: there was none.
  std::uint64_t drop_last_chunk();

  std::uint64_t bytes() const { return end_; }
  std::uint64_t messages() const;
  std::size_t chunks() const { return chunks_.size(); }

 private:
  explicit McapWriter(std::unique_ptr<ByteFile> file) : file_(std::move(file)) {}
  std::string summary_at(std::uint64_t start, const McapRegistry& registry) const;
  Result<void> write(std::string_view bytes);

  std::unique_ptr<ByteFile> file_;
  std::uint64_t end_ = 0;
  std::uint32_t crc_ = 0;       ///< Of all that was written.
  bool has_crc_ = true;         ///< Not after resume().
  std::vector<McapChunkInfo> chunks_;
  std::vector<std::map<std::uint16_t, std::uint64_t>> counts_of_appended_;  ///< By channel, of the last chunks: those that were not resumed.
  std::vector<MetadataEntry> metadata_;
  std::map<std::uint16_t, std::uint64_t> message_counts_;  ///< By channel.
};

}  // namespace gfp
