#pragma once

#include "cli/canvas.hpp"
#include "gfp/core/camera_model.hpp"
#include "gfp/core/transform.hpp"
#include "gfp/frame/frame.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// A virtual camera, `side_px` square, that looks at the fitted objects (at the support's middle where there are none).
struct SideView {
  CameraModel camera;
  Transform T_view_camera = Transform::Identity();
  Eigen::Vector3d target_camera = Eigen::Vector3d::Zero();  ///< What it looks at, in the real camera's frame.
  double radius_m = 0.3;                                    ///< Of what it shows.
};

/// Turned by 60 degrees about the support's up (the image's up where none is known), at 15 to 45 degrees of elevation.
SideView side_view(const Scene& scene, int side_px);

/// Splats the frame's readings around the target; returns their depths in the view (0: none).
Image<float> draw_points(Canvas& canvas, const Frame& frame, const SideView& view);

}  // namespace gfp
