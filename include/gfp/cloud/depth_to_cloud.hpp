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

/// Back-projects every reading through the camera model (distortion removed). It cannot fail: no reading, no point.
OrganizedCloud depth_to_cloud(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions& options = {});

/// The same into a buffer that is reused from frame to frame.
void depth_to_cloud_into(const DepthImage& depth, const CameraModel& camera, const DepthToCloudOptions& options, OrganizedCloud& cloud);

}  // namespace gfp
