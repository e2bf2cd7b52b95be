#pragma once

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

struct DepthToCloudOptions {
  double min_depth_m = 0.3;  ///< Nearer readings are dropped: structured light is unreliable there.
  double max_depth_m = 6.0;  ///< Farther readings are dropped: quantisation grows with z^2.
};

template <class Visitor>
void visit_fields(DepthToCloudOptions& o, Visitor&& field) {
  field("min_depth_m", o.min_depth_m, 0.0, 10.0);
  field("max_depth_m", o.max_depth_m, 0.1, 30.0);
}

/// Back-projects every reading through the camera model (distortion removed): p = z * ray(u, v), z = reading * scale.
/// Readings outside the depth range and zeros become NaN in x, y and z. It cannot fail: no reading, no point; an image
/// whose size is not the camera's gives an empty cloud. Cost: memory-bound, below a copy of its output.
OrganizedCloud depth_to_cloud(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions& options = {});

/// The same into a buffer that is reused from frame to frame; its ray table is kept while the camera is the same.
void depth_to_cloud_into(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions& options, OrganizedCloud& cloud);

/// The rays of `camera`. Distortion is inverted by Newton's method to 1e-9 of the focal length; where it does not
/// converge (beyond the range in which the polynomial can be inverted) the ray is NaN, and so is the pixel's point.
RayTable ray_table(const CameraModel& camera);

}  // namespace gfp
