#pragma once

#include "gfp/core/camera_model.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// The colour of every depth pixel, seen by a parallel camera `offset_m` to the right of the depth camera. Pixels without a reading
/// or outside the colour image are black. What the colour camera does not see for something nearer gets that thing's colour.
/// Distortion is not modelled. Cost: 3 ms at 640 x 480.
Image<Rgb8> register_color(const DepthImage& depth, const CameraModel& depth_camera, const Image<Rgb8>& color, const CameraModel& color_camera, double offset_m);

}  // namespace gfp
