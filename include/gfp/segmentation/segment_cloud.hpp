#pragma once

#include <optional>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// Extended by whoever writes the stage; every member documented, bounded in visit_fields and used.
struct SegmentationOptions {
  double plane_inlier_m = 0.010;       ///< Half thickness of a support plane at 1 m; grows with the sensor noise.
  double cluster_tolerance_m = 0.010;  ///< Points of one object are no farther apart than this (plus what the pixel pitch demands).
  int min_points = 300;                ///< Smaller clusters are rejected (`too_small`).
  double min_height_m = 0.012;         ///< Flatter clusters are rejected (`too_flat`).
  double max_size_m = 0.60;            ///< Larger clusters are rejected (`too_large`).
  int max_segments = 128;              ///< The largest are kept.
};

template <class Visitor>
void visit_fields(SegmentationOptions& o, Visitor&& field) {
  field("plane_inlier_m", o.plane_inlier_m, 0.001, 0.05);
  field("cluster_tolerance_m", o.cluster_tolerance_m, 0.001, 0.1);
  field("min_points", o.min_points, 10, 100'000);
  field("min_height_m", o.min_height_m, 0.0, 0.2);
  field("max_size_m", o.max_size_m, 0.02, 3.0);
  field("max_segments", o.max_segments, 1, 1000);
}

/// Finds support planes and the objects on them (P3). `up_camera` from an accelerometer, `last` the plane of the frame
/// before (tried first). `mask`: non-empty = the user's mask, whose pixels become the one segment. No plane and no object are results.
Segments segment_cloud(const OrganizedCloud& cloud, const SegmentationOptions& options = {},
                       const std::optional<Eigen::Vector3d>& up_camera = std::nullopt, const SupportPlane* last = nullptr,
                       const Image<std::uint8_t>& mask = {});

}  // namespace gfp
