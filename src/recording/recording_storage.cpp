#include <fmt/format.h>

#include <algorithm>

#include "gfp/recording/recording_series.hpp"
#include "gfp/recording/repair.hpp"

namespace gfp {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> refused(const fs::path& path, const std::error_code& error) { return failure(ErrorCode::kIo, fmt::format("{}: {}", path.string(), error.message())); }

/// Files <prefix>_*<ending> of a folder, by name, which is by time.
std::vector<fs::path> files_of(const fs::path& folder, const std::string& prefix, const std::string& ending) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(prefix + "_") && name.ends_with(ending)) files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class DiskStorage final : public RecordingStorage {
 public:
  Result<std::unique_ptr<ByteFile>> create(const fs::path& file) override {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) return refused(file.parent_path(), error);
    return create_file(file);
  }
  Result<void> rename(const fs::path& from, const fs::path& to) override {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) return refused(from, error);
    return {};
  }
  Result<void> remove(const fs::path& file) override {
    std::error_code error;
    fs::remove(file, error);
    if (error) return refused(file, error);
    return {};
  }
  std::vector<fs::path> closed_files(const fs::path& folder, const std::string& prefix) override { return files_of(folder, prefix, ".mcap"); }
  Result<std::uint64_t> free_bytes(const fs::path& folder) override {
    std::error_code error;
    fs::create_directories(folder, error);
    const fs::space_info space = fs::space(folder, error);
    if (error) return refused(folder, error);
    return space.available;
  }
};

}  // namespace

std::unique_ptr<RecordingStorage> disk_storage() { return std::make_unique<DiskStorage>(); }

std::vector<Recovered> recover_recordings(const fs::path& folder, const std::string& prefix) {
  std::vector<Recovered> recovered;
  for (const fs::path& file : files_of(folder, prefix, ".mcap.active")) {
    if (is_being_written(file)) continue;
    const auto report = repair_mcap(file);
    if (!report) {
      recovered.push_back({file, report.error().what, false});
      continue;
    }
    fs::path closed = file;
    closed.replace_extension();  // .active
    std::error_code error;
    fs::rename(file, closed, error);
    if (error) recovered.push_back({file, error.message(), false});
    else recovered.push_back({closed, fmt::format("{} messages in {} chunks, {} damaged places left out", report->messages, report->chunks, report->damage.size()), true});
  }
  return recovered;
}

}  // namespace gfp
