#pragma once

#include <cstdint>

#include "gfp/frame/stereo_calibration.hpp"
#include "gfp/frame/stereo_pair.hpp"
#include "gfp/simulation/virtual_camera.hpp"

namespace gfp {

/// What both eyes of a perfect stereo camera see of a scene whose surfaces carry a grain that is fixed to the world (solid noise of 3, 8 and 25 mm), with
/// pixel noise of `noise` grey values. The left eye stands at T_world_left. Deterministic for one seed. Cost: about 0.2 s at 640 x 480.
StereoPair textured_pair(const VirtualScene& scene, const CameraModel& camera, double baseline_m, const Transform& T_world_left, double noise, std::uint64_t seed);

/// The calibration of such a pair: it is rectified already.
StereoCalibration calibration_of_pair(const CameraModel& camera, double baseline_m, const Transform& T_world_left);

}  // namespace gfp
