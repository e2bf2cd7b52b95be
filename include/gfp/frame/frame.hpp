#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "gfp/core/camera_model.hpp"
#include "gfp/core/image.hpp"
#include "gfp/core/sensor_noise.hpp"
#include "gfp/core/time.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {

/// 16-bit depth along the optical axis; 0 is "no reading" (REP 118). Metres = value * scale_m.
/// Sources with float depth choose a scale fine enough to lose nothing that the sensor measured (0.1 mm up to 6.5 m).
struct DepthImage {
  Image<std::uint16_t> pixels;
  double scale_m = 0.001;
};

/// One capture of one sensor; owns its calibration. Immutable once handed over.
struct Frame {
  std::string sensor;                    ///< Name of the source, as in topics: [a-z0-9_]+.
  std::uint64_t sequence = 0;            ///< Per session and sensor, from 0.
  Stamps stamps;
  DepthImage depth;
  Image<Rgb8> color;                     ///< Registered to depth; empty where the sensor has none.
  CameraModel camera;                    ///< Of the depth image.
  SensorNoise noise;
  Transform T_world_sensor = Transform::Identity();
  std::optional<Eigen::Vector3d> up_camera;  ///< Unit, from the accelerometer, where there is one.
  Image<std::uint8_t> mask;              ///< Optional, from the user (`--mask`): non-zero pixels are the one object.
};

using FramePtr = std::shared_ptr<const Frame>;

}  // namespace gfp
