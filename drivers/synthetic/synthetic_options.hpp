#pragma once

#include <cstdint>
#include <numbers>
#include <string>

#include "gfp/core/fields.hpp"
#include "gfp/simulation/table_top_scene.hpp"
#include "gfp/simulation/virtual_camera.hpp"

namespace gfp {

struct SyntheticOptions {
  std::string sensor = "synthetic";  ///< Name of the source, as in topics.
  std::uint64_t seed = 1;            ///< Of scene and noise.
  double rate_hz = 30;               ///< Frames a second; 0: as fast as they are taken (stamps then are those of 30 Hz).
  std::uint64_t frames = 0;          ///< Then the stream ends; 0: it never does.
  bool frame_time = false;           ///< Deterministic mode: the host stamps are the sensor's, no clock is read.
  std::string motion = "static";     ///< Of the camera: `static`, or `orbit` about the table.
  double distance_m = 0.9;           ///< From the middle of the table (5 cm above it).
  double elevation_rad = 40 * std::numbers::pi / 180;
  double azimuth_rad = -std::numbers::pi / 2;  ///< Where the camera stands (at the start, for an orbit); -pi/2: at the table's long side, facing the wall.
  double orbit_period_s = 24;        ///< For once around the table.
  double orbit_swing_rad = 0.6;      ///< The camera swings so far to both sides; pi or more: it goes all the way around.
  TableTopOptions table;
  VirtualCameraOptions camera;       ///< A Kinect: 640 x 480, 525 px.
};

template <class Visitor>
void visit_fields(SyntheticOptions& o, Visitor&& field) {
  field("seed", o.seed, std::uint64_t{0}, UINT64_MAX);
  field("rate_hz", o.rate_hz, 0.0, 1000.0);
  field("frames", o.frames, std::uint64_t{0}, UINT64_MAX);
  field("motion", o.motion, OneOf{{"static", "orbit"}});
  field("distance_m", o.distance_m, 0.3, 5.0);
  field("elevation_rad", o.elevation_rad, 0.05, std::numbers::pi / 2);
  field("azimuth_rad", o.azimuth_rad, -2 * std::numbers::pi, 2 * std::numbers::pi);
  field("orbit_period_s", o.orbit_period_s, 0.1, 3600.0);
  field("orbit_swing_rad", o.orbit_swing_rad, 0.0, 7.0);
  field.section("table", o.table);
  field.section("camera", o.camera);
}

}  // namespace gfp
