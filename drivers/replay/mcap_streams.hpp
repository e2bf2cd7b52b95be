#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gfp/recording/mcap_reader.hpp"
#include "replay/load_frame.hpp"

namespace gfp {

/// The frames of a recording, any of which can be read at any time. Ours are given back bit by bit; of other recorders' files the
/// topics that hold depth, camera and colour are found by schema and name, or named by the options.
class McapStreams {
 public:
  /// Of several sensors that a gfpd recorded: that of the options' topic, else of their name, else the first.
  /// Errors: as McapReader::open() and messages(); kUnsupported (no depth images, or no topic of that name), which lists what is there.
  static Result<McapStreams> open(const std::filesystem::path& file, const ReplayOptions& options);

  /// The sensors that a gfpd recorded into the file, by name; none: others made it. Errors: as McapReader::open().
  static Result<std::vector<std::string>> recorded_sensors(const std::filesystem::path& file);

  /// The sensor's name where a gfpd recorded it, else `replay`.
  const std::string& recorded_sensor() const { return recorded_sensor_; }
  std::size_t frames() const { return depth_.size(); }
  Nanoseconds time(std::size_t index) const { return Nanoseconds(static_cast<std::int64_t>(depth_[index].log_time_ns)); }  ///< Of recording; does not fall.

  /// The frame with the recorded stamps; its camera and world pose may be the options'. Errors: as McapReader::read(), and those of
  /// the images and cameras in it.
  Result<LoadedFrame> load(std::size_t index);

 private:
  explicit McapStreams(McapReader reader, ReplayOptions options, std::filesystem::path file)
      : reader_(std::move(reader)), options_(std::move(options)), file_(std::move(file)) {}
  Result<void> choose_ours(const std::string& sensor);
  Result<void> choose_theirs();
  const McapChannel* channel_of(const std::string& topic) const;
  std::string schema_name(const McapChannel& channel) const;
  Result<std::vector<McapMessageRef>> refs_of(const McapChannel& channel);
  Result<LoadedFrame> load_ours(std::size_t index);
  Result<LoadedFrame> load_theirs(std::size_t index);
  Result<void> put_camera(LoadedFrame& loaded, std::uint64_t time_ns);
  std::string what_is_there() const;

  McapReader reader_;
  ReplayOptions options_;
  std::filesystem::path file_;
  bool is_ours_ = false;
  std::string recorded_sensor_ = "replay";
  std::set<std::string> left_out_;                      ///< Topics of the other sensors' depth, where none was asked for by topic or name.
  std::string depth_schema_, color_schema_, camera_schema_;
  std::vector<McapMessageRef> depth_;                   ///< One a frame.
  std::map<std::uint64_t, McapMessageRef> info_;        ///< Ours, by log time.
  std::map<std::uint64_t, McapMessageRef> color_, camera_;
  std::map<std::uint64_t, CameraModel> cameras_;        ///< The last that was read, by its time.
};

}  // namespace gfp
