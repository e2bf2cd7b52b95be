#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gfp/core/fields.hpp"
#include "gfp/core/sensor_noise.hpp"
#include "gfp/frame/camera_file.hpp"

namespace gfp {

struct OpenNi2Options {
  std::string sensor = "openni2";    ///< Name of the source, as in topics.
  std::string uri;                   ///< Of a device, or an .oni file; empty: any device.
  std::string library = "libOpenNI2.so.0";  ///< Drivers are looked for in OpenNI2/Drivers beside it.
  bool color = true;
  int width = 640, height = 480;     ///< Of a device's streams; a file has its own.
  double rate_hz = 30;
  bool fast = false;                 ///< A file: as fast as frames are taken, instead of in its own time.
  std::uint64_t first_frame = 0;     ///< A file: so many frames are passed over (OpenNI2's own seeking crashes).
  std::string record;                ///< Also records into this .oni file, losslessly: whatever is delivered is in it.
  bool frame_time = false;           ///< Deterministic mode: the host stamps are the sensor's, no clock is read.
  std::optional<CameraFile> camera;  ///< Empty: from the stream's fields of view.
  SensorNoise noise;
};

/// What a configuration's `openni2` section holds; sensor, URI and camera are said once, beside it, for every driver.
template <class Visitor>
void visit_fields(OpenNi2Options& o, Visitor&& field) {
  field("library", o.library);
  field("color", o.color);
  field("width", o.width, 160, 1920);
  field("height", o.height, 120, 1200);
  field("rate_hz", o.rate_hz, 1.0, 120.0);
  field("fast", o.fast);
  field("first_frame", o.first_frame, std::uint64_t{0}, UINT64_MAX);
  field("record", o.record);
}

}  // namespace gfp
