#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "gfp/core/error.hpp"
#include "gfp/frame/camera_file.hpp"
#include "replay/mcap_source.hpp"
#include "replay/replay_source.hpp"

namespace gfp {

/// What a user says of a recording that it does not say itself.
struct InputOptions {
  std::optional<CameraFile> camera;
  std::optional<double> depth_scale_m;  ///< Metres per unit of 16-bit depth.
  std::string axes;                     ///< As parse_axes() reads them; empty: found from the cloud.
};

/// One recording, to be read frame by frame as fast as it is taken, with the recording's own time (nothing reads a clock).
struct Input {
  std::string name;                      ///< As the user gave it.
  std::string stem;                      ///< For the names of what is made of it.
  std::unique_ptr<FrameSource> source;   ///< Open.
  const ReplaySource* replay = nullptr;  ///< The same, where it is one.
  const McapSource* mcap = nullptr;      ///< Likewise.

  bool has_many_frames() const { return replay == nullptr || replay->frames() > 1; }
  /// How the last frame came to be; of what is no replay, nothing is to be said.
  FrameReport report() const { return replay != nullptr ? replay->report() : mcap != nullptr ? mcap->report() : FrameReport{}; }
};

/// Opens a file or folder (DESIGN, `gfp fit INPUT`). Errors: as open_replay(), for .oni as make_openni2_source(), and kUnsupported
/// where this build has no OpenNI2; they name the file.
Result<Input> open_input(const std::string& name, const InputOptions& options);

}  // namespace gfp
