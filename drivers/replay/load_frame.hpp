#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gfp/core/error.hpp"
#include "gfp/frame/frame.hpp"
#include "replay/listing.hpp"
#include "replay/replay_options.hpp"

namespace gfp {

enum class CameraOrigin {
  kGiven,    ///< By the options.
  kFile,     ///< By the recording.
  kFitted,   ///< From the cloud's own points.
  kAssumed,  ///< Nothing is known: the usual Kinect camera. Sizes of objects are only as right as that is.
};

/// How a frame came to be, for people and for `gfp fit --json`.
struct FrameReport {
  std::filesystem::path file;
  CameraOrigin camera_origin = CameraOrigin::kAssumed;
  std::string axes = "xyz";        ///< Of the file, as to_string(Axes) writes them.
  double pinhole_rms_px = 0;       ///< Of the fitted camera; 0 where none was fitted.
  std::vector<std::string> notes;  ///< What a person should know: one sentence each, without the file's name.
};

std::string_view to_string(CameraOrigin origin);

struct LoadedFrame {
  Frame frame;  ///< Without sequence and stamps.
  FrameReport report;
};

/// Reads one frame. Clouds are turned into depth images in the optical frame; what is in their x and y beyond the pinhole
/// camera (under half a pixel, else it is an error) is dropped.
/// Errors: kNotFound, kIo, kCorruptData, kTooLarge, kUnsupported, kTooFewPoints (an empty cloud without a camera),
/// kInvalidArgument (axes, or a camera that does not suit the images). A bad colour image is a note, not an error.
Result<LoadedFrame> load_frame(const ReplayEntry& entry, const ReplayOptions& options);

/// z in metres as 16-bit depth, in the finest of 0.1 mm, 0.2 mm, ... 1 mm that holds the farthest reading. NaN, values
/// not above 0 and what is beyond 65.535 m are no readings.
DepthImage quantise_depth(int width, int height, const std::vector<float>& z_m);

}  // namespace gfp
