#pragma once

#include <set>

#include "foxglove/scene.pb.h"
#include "foxglove/sensor.pb.h"
#include "gfp/frame/frame.hpp"
#include "gfp/scene/scene.hpp"
#include "gfp/v1/status.pb.h"

namespace gfp::wire {

/// What Foxglove's viewers show: our products as messages of the public schemas. Coordinates are in the frame
/// `<sensor>_optical` (x right, y down, z forward, metres); stamps are the host's CLOCK_REALTIME at the frame's arrival.

void fill_depth_image(const Frame& frame, foxglove::RawImage& message);   ///< 16UC1, millimetres.
void fill_color_image(const Frame& frame, foxglove::RawImage& message);   ///< rgb8; call only where the frame has one.
void fill_calibration(const Frame& frame, foxglove::CameraCalibration& message);
void fill_cloud(const Frame& frame, foxglove::PointCloud& message);       ///< x y z float32 and, with colour, red green blue alpha uint8; holes left out.
void fill_transforms(const Frame& frame, foxglove::FrameTransforms& message);  ///< `world` to the sensor.

/// Meshes (seen vertices brighter), labels and the best grasp of each object as a gripper. They vanish by themselves where no
/// scene follows for three seconds.
void fill_scene_update(const Scene& scene, foxglove::SceneUpdate& message);

void fill_log(const v1::LogRecord& record, foxglove::Log& message);

}  // namespace gfp::wire
