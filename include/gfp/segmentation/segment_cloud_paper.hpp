#pragma once

#include <optional>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/segmentation/segment_cloud.hpp"

namespace gfp {

/// The paper's segmentation (P3, Rus09a) with PCL's parts: the greatest plane by RANSAC that objects stand on, and Euclidean clusters
/// of what lies above its outline. One plane carries everything; touching objects are one cluster; nothing is down-sampled (P9).
///
/// Up to three planes are taken off until one qualifies: within 30 degrees of `up_camera`, or seen from above where that is unknown,
/// with at least options.min_points points above it. `mask`: as for segment_cloud. No plane and no object are results.
/// Cost: 100 to 400 ms at 640 x 480.
Segments segment_cloud_paper(const OrganizedCloud& cloud, const SegmentationOptions& options = {},
                             const std::optional<Eigen::Vector3d>& up_camera = std::nullopt, const Image<std::uint8_t>& mask = {});

}  // namespace gfp
