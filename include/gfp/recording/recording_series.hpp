#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/core/fields.hpp"
#include "gfp/core/time.hpp"
#include "gfp/recording/mcap_writer.hpp"
#include "gfp/recording/record_content.hpp"

namespace gfp {

struct RecordingOptions {
  std::string mode = "off";           ///< `continuous`; `ring`: the last `ring_s` are kept in memory, and a trigger writes them.
  std::string folder = "recordings";  ///< Made where it is not there.
  std::string prefix = "gfp";         ///< Files are <prefix>_<UTC time>.mcap, while they are written .mcap.active.
  RecordContent content;
  int zstd_level = 1;
  double max_file_s = 600;            ///< Then the next file begins.
  double max_file_mb = 2048;
  double min_free_mb = 1024;          ///< Less on the disk, and nothing is written until there is more again.
  bool delete_oldest = false;         ///< Instead: files of this prefix are deleted, the oldest first.
  double ring_s = 30;
  double ring_mb = 256;               ///< Of memory, compressed.
  double after_trigger_s = 10;        ///< So much after a trigger is written too.
};

template <class Visitor>
void visit_fields(RecordingOptions& o, Visitor&& field) {
  field("mode", o.mode, OneOf{{"off", "continuous", "ring"}});
  field("folder", o.folder);
  field("prefix", o.prefix);
  field.section("content", o.content);
  field("zstd_level", o.zstd_level, 0, 19);
  field("max_file_s", o.max_file_s, 1.0, 86'400.0);
  field("max_file_mb", o.max_file_mb, 1.0, 1e6);
  field("min_free_mb", o.min_free_mb, 0.0, 1e7);
  field("delete_oldest", o.delete_oldest);
  field("ring_s", o.ring_s, 0.2, 3600.0);
  field("ring_mb", o.ring_mb, 1.0, 16'384.0);
  field("after_trigger_s", o.after_trigger_s, 0.0, 3600.0);
}

/// Where recordings go, so that tests can put a failing disk in its place. One thread at a time.
class RecordingStorage {
 public:
  virtual ~RecordingStorage() = default;
  virtual Result<std::unique_ptr<ByteFile>> create(const std::filesystem::path& file) = 0;
  virtual Result<void> rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  virtual Result<void> remove(const std::filesystem::path& file) = 0;
  /// Files <prefix>_*.mcap of the folder, the oldest first.
  virtual std::vector<std::filesystem::path> closed_files(const std::filesystem::path& folder, const std::string& prefix) = 0;
  virtual Result<std::uint64_t> free_bytes(const std::filesystem::path& folder) = 0;
};
std::unique_ptr<RecordingStorage> disk_storage();

/// What became of a recording so far.
struct RecordingStatus {
  enum class State { kIdle, kRecording, kNoSpace, kFailing };
  State state = State::kIdle;       ///< kIdle: a ring that waits for its trigger. kFailing: the last write was refused.
  std::uint64_t messages = 0;       ///< In files.
  std::uint64_t bytes = 0;          ///< Of files.
  std::uint64_t files = 0;          ///< That were closed.
  std::uint64_t lost_messages = 0;  ///< That should have gone into a file.
  std::uint64_t write_errors = 0;
  std::string last_error;
  std::filesystem::path file;       ///< That is being written; empty: none.
};

/// Files of one recording: chunks at most 1 MiB or 200 ms long, on the disk within a second; a new file by size and time; nothing
/// written where the disk is too full. A refused write costs its chunk and is counted, and the recording goes on with the next.
/// Knows no clock: `now` is monotonic, log times are the messages' own. One thread at a time.
class RecordingSeries {
 public:
  using Now = Nanoseconds;

  /// `storage` must live longer.
  RecordingSeries(RecordingOptions options, RecordingStorage& storage);
  ~RecordingSeries();  ///< As close().

  /// Takes in one message of the channel that `spec` describes; `message.channel` is set here.
  void put(const McapChannelSpec& spec, McapMessage message, Now now);
  /// What time alone brings about; to be called at least ten times a second.
  void tick(Now now);
  /// Of a ring: writes what it holds and what comes in the next `after_trigger_s`.
  void trigger(Now now);
  /// Closes the file. A ring that waits writes nothing.
  void close();

  const RecordingStatus& status() const { return status_; }

 private:
  void take(Result<std::optional<McapChunk>> chunk, std::size_t waiting, Now now);
  void keep_in_ring(McapChunk chunk, Now now);
  void write(const McapChunk& chunk, Now now);
  bool open_file(Now now);
  void finish_file();
  bool make_room_for_end();
  bool has_space(Now now);
  void fail(const Error& error, std::uint64_t messages);
  std::filesystem::path next_name(std::uint64_t first_log_time_ns) const;

  struct Kept {
    McapChunk chunk;
    Now since{};
  };

  const RecordingOptions options_;
  RecordingStorage& storage_;
  McapEncoder encoder_;
  std::map<std::string, std::uint16_t> channels_;  ///< By topic.
  std::optional<McapWriter> writer_;
  std::deque<Kept> ring_;
  std::uint64_t ring_bytes_ = 0;
  std::optional<Now> record_until_;   ///< Of a ring that was triggered.
  Now chunk_began_{}, file_began_{}, synced_{}, space_checked_{-1};
  bool has_space_ = true, needs_sync_ = false;
  std::uint64_t next_file_time_ns_ = 0;
  std::filesystem::path final_name_;
  RecordingStatus status_;
};

/// Closes what a kill or power loss left of recordings of this prefix: repairs <prefix>_*.mcap.active and takes the ending away.
/// What cannot be repaired, or is still being written by another process, stays as it is. Gives what was done, file by file.
struct Recovered {
  std::filesystem::path file;
  std::string what;  ///< For a person.
  bool is_whole = false;
};
std::vector<Recovered> recover_recordings(const std::filesystem::path& folder, const std::string& prefix);

}  // namespace gfp
