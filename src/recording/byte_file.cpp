#include "gfp/recording/byte_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace gfp {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  int get() const { return number_; }

 private:
  int number_;
};

tl::unexpected<Error> system_failure(const std::filesystem::path& path, std::string_view what, int error) {
  const ErrorCode code = error == ENOENT ? ErrorCode::kNotFound : ErrorCode::kIo;
  return failure(code, fmt::format("{}: {}: {}", path.string(), what, std::strerror(error)));
}

class PosixFile final : public ByteFile {
 public:
  PosixFile(std::filesystem::path path, Descriptor file) : path_(std::move(path)), file_(std::move(file)) {}

  Result<void> write_at(std::uint64_t offset, std::string_view bytes) override {
    while (!bytes.empty()) {
      const ssize_t written = pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return system_failure(path_, "cannot be written", written == 0 ? ENOSPC : errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
      offset += static_cast<std::uint64_t>(written);
    }
    return {};
  }
  Result<void> truncate(std::uint64_t size) override {
    if (ftruncate(file_.get(), static_cast<off_t>(size)) != 0) return system_failure(path_, "cannot be cut", errno);
    return {};
  }
  Result<void> sync() override {
    if (fdatasync(file_.get()) != 0) return system_failure(path_, "cannot be synchronised", errno);
    return {};
  }

 private:
  std::filesystem::path path_;
  Descriptor file_;
};

class PosixSource final : public ByteSource {
 public:
  PosixSource(std::filesystem::path path, Descriptor file, std::uint64_t size) : path_(std::move(path)), file_(std::move(file)), size_(size) {}

  std::uint64_t size() const override { return size_; }
  Result<void> read_at(std::uint64_t offset, std::size_t count, std::string& out) override {
    out.clear();
    if (offset >= size_) return {};
    out.resize(static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset)));
    std::size_t done = 0;
    while (done < out.size()) {
      const ssize_t got = pread(file_.get(), out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return system_failure(path_, "cannot be read", errno);
      if (got == 0) break;  // it became shorter
      done += static_cast<std::size_t>(got);
    }
    out.resize(done);
    return {};
  }

 private:
  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t size_;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t size() const override { return bytes_.size(); }
  Result<void> read_at(std::uint64_t offset, std::size_t count, std::string& out) override {
    out = offset < bytes_.size() ? bytes_.substr(static_cast<std::size_t>(offset), count) : std::string();
    return {};
  }

 private:
  std::string bytes_;
};

Result<std::unique_ptr<ByteFile>> open_for_writing(const std::filesystem::path& path, int flags) {
  Descriptor file(open(path.c_str(), O_WRONLY | O_CLOEXEC | (flags & ~O_TRUNC), 0644));
  if (file.get() < 0) return system_failure(path, "cannot be opened for writing", errno);
  if (flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return failure(ErrorCode::kIo, fmt::format("{}: another process is writing it", path.string()));
  if ((flags & O_TRUNC) != 0 && ftruncate(file.get(), 0) != 0) return system_failure(path, "cannot be cut", errno);
  return std::unique_ptr<ByteFile>(std::make_unique<PosixFile>(path, std::move(file)));
}

}  // namespace

Result<std::unique_ptr<ByteFile>> create_file(const std::filesystem::path& path) { return open_for_writing(path, O_CREAT | O_TRUNC); }
Result<std::unique_ptr<ByteFile>> open_file_for_update(const std::filesystem::path& path) { return open_for_writing(path, 0); }

bool is_being_written(const std::filesystem::path& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return file.get() >= 0 && flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

Result<std::unique_ptr<ByteSource>> open_source(const std::filesystem::path& path) {
  Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) return system_failure(path, "cannot be opened", errno);
  struct stat status {};
  if (fstat(file.get(), &status) != 0) return system_failure(path, "cannot be examined", errno);
  if (!S_ISREG(status.st_mode)) return failure(ErrorCode::kUnsupported, fmt::format("{}: not a regular file", path.string()));
  return std::unique_ptr<ByteSource>(std::make_unique<PosixSource>(path, std::move(file), static_cast<std::uint64_t>(status.st_size)));
}

std::unique_ptr<ByteSource> source_of(std::string bytes) { return std::make_unique<MemorySource>(std::move(bytes)); }

}  // namespace gfp
