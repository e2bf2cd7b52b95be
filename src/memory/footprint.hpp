#pragma once

#include <Eigen/Core>
#include <vector>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// Convex outline of what was seen of a segment, dropped onto the support plane; support frame, metres.
/// Looks at about 2000 of its pixels.
std::vector<Eigen::Vector2d> footprint(const Segment& segment, const OrganizedCloud& cloud, const Transform& T_camera_support);

}  // namespace gfp
