#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp {

/// A file that is being written, so that tests can put a failing one in its place. One thread at a time.
class ByteFile {
 public:
  virtual ~ByteFile() = default;
  /// All of the bytes, or an error; then what lies from `offset` on is not known, and writing there again is fine.
  virtual Result<void> write_at(std::uint64_t offset, std::string_view bytes) = 0;
  virtual Result<void> truncate(std::uint64_t size) = 0;
  virtual Result<void> sync() = 0;  ///< What was written survives a power loss (fdatasync).
};

/// A file that is being read. One thread at a time.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  virtual std::uint64_t size() const = 0;
  /// Replaces `out` by up to `count` bytes from `offset`: fewer only at the end. Errors: kIo.
  virtual Result<void> read_at(std::uint64_t offset, std::size_t count, std::string& out) = 0;
};

/// Who writes a file holds a lock on it (flock) for as long as the ByteFile lives, so that nobody repairs what is still being written.
/// Errors: kIo naming the path and the system's reason, or that another process is writing it.
Result<std::unique_ptr<ByteFile>> create_file(const std::filesystem::path& path);
Result<std::unique_ptr<ByteFile>> open_file_for_update(const std::filesystem::path& path);
bool is_being_written(const std::filesystem::path& path);
/// Errors: kNotFound, kUnsupported (not a regular file), kIo.
Result<std::unique_ptr<ByteSource>> open_source(const std::filesystem::path& path);
std::unique_ptr<ByteSource> source_of(std::string bytes);

}  // namespace gfp
