#pragma once

#include <optional>
#include <string>

#include "gfp/core/fields.hpp"
#include "gfp/core/sensor_noise.hpp"
#include "gfp/frame/camera_file.hpp"
#include "gfp/frame/kinect_depth.hpp"

namespace gfp {

struct FreenectOptions {
  std::string sensor = "kinect";      ///< Name of the source, as in topics.
  std::string folder;                 ///< Recorded by libfreenect, played by fakenect in its own time; empty: a device.
  std::string serial;                 ///< Of the camera; empty: the first one.
  std::string library;                ///< Shared library to load; empty: libfreenect, or fakenect's beside it for a folder.
  std::string depth = "raw";          ///< `raw`: 11 bit, converted here; `mm`: by libfreenect; `registered`: likewise, as the colour camera sees it.
  bool device_calibration = true;     ///< `raw`: prefer the table that the device's own calibration gives, where there is one.
  KinectDepthCalibration calibration; ///< `raw`: else this one.
  bool color = true;
  double color_focal_px = 525;        ///< Of the colour camera, principal point in the middle.
  double color_offset_m = 0.025;      ///< It stands so far to the right of the depth camera.
  std::string led = "green";
  bool move_tilt = false;             ///< Moves the motor to `tilt_rad` when opened.
  double tilt_rad = 0;                ///< Above the horizon.
  std::optional<CameraFile> camera;   ///< Of the depth image; empty: f = 575.8 px (raw, mm) or 525 px (registered).
  SensorNoise noise;
};

/// What a configuration's `freenect` section holds; sensor, folder and camera are said once, beside it, for every driver.
template <class Visitor>
void visit_fields(FreenectOptions& o, Visitor&& field) {
  field("serial", o.serial);
  field("library", o.library);
  field("depth", o.depth, OneOf{{"raw", "mm", "registered"}});
  field("device_calibration", o.device_calibration);
  field.section("calibration", o.calibration);
  field("color", o.color);
  field("color_focal_px", o.color_focal_px, 100.0, 5000.0);
  field("color_offset_m", o.color_offset_m, -1.0, 1.0);
  field("led", o.led, OneOf{{"off", "green", "red", "yellow", "blink_green", "blink_red_yellow"}});
  field("move_tilt", o.move_tilt);
  field("tilt_rad", o.tilt_rad, -0.54, 0.54);
}

}  // namespace gfp
