#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gfp/core/sensor_noise.hpp"
#include "gfp/frame/camera_file.hpp"

namespace gfp {

class ReplayControl;

struct ReplayOptions {
  std::string sensor = "replay";        ///< Name of the source, as in topics; empty: of an MCAP recording, the name that it was recorded under.
  double rate_hz = 30;                  ///< Frames a second of files and folders; 0: as fast as they are taken.
  bool loop = false;                    ///< Starts over at the end, stamps go on rising.
  int step = 1;                         ///< Every so many-th frame is played.
  double speed = 1;                     ///< Of an MCAP recording, times its own rhythm; 0: as fast as frames are taken. So it is where rate_hz is 0.
  double start_s = 0;                   ///< So much of its beginning is left out.
  std::string topic;                    ///< Of its depth images; empty: found.
  std::string color_topic;              ///< Of colour registered to depth, in the files of others; ours are found.
  std::shared_ptr<ReplayControl> control;  ///< To pause, step and seek it; may be empty.
  bool recorded_time = false;           ///< Of an MCAP recording: the host's CLOCK_REALTIME stamps are those of recording, so that a viewer's time line is the file's.
  bool frame_time = false;              ///< Deterministic mode: the host stamps are the sensor's, no clock is read.
  std::string axes;                     ///< Of clouds, as parse_axes() reads them; empty: found from the cloud.
  std::optional<double> depth_scale_m;  ///< Metres per unit of 16-bit depth; wins over the camera file and the format.
  std::optional<CameraFile> camera;     ///< Wins over what the files say.
  SensorNoise noise;                    ///< Of the sensor that took the recording.
};

/// What a configuration's `replay` section holds; sensor and camera are said once, beside it, for every driver.
template <class Visitor>
void visit_fields(ReplayOptions& o, Visitor&& field) {
  field("rate_hz", o.rate_hz, 0.0, 1000.0);
  field("loop", o.loop);
  field("step", o.step, 1, 1'000'000);
  field("speed", o.speed, 0.0, 1000.0);
  field("start_s", o.start_s, 0.0, 1e9);
  field("topic", o.topic);
  field("color_topic", o.color_topic);
  field("axes", o.axes);
}

}  // namespace gfp
