#pragma once

#include <optional>

#include "gfp/cloud/organized_cloud.hpp"
#include "gfp/segmentation/segments.hpp"

namespace gfp {

/// What counts as a support, as an object and as near enough.
struct SegmentationOptions {
  double plane_inlier_m = 0.010;       ///< Greatest half thickness of a support plane at 1 m (times z^2 elsewhere); the noise that the plane shows decides below that.
  double cluster_tolerance_m = 0.010;  ///< Neighbouring pixels of one object differ by less in depth at 1 m and nearer (times z^2 beyond); gaps without readings are bridged as far.
  double edge_margin_m = 0.02;         ///< Objects may stand out over the edge of the seen surface by this much.
  int min_points = 300;                ///< Smaller clusters are rejected (`too_small`).
  double min_height_m = 0.007;         ///< Flatter clusters are rejected (`too_flat`).
  double max_height_m = 0.60;          ///< Nothing higher above its support belongs to an object.
  double max_size_m = 0.60;            ///< Larger clusters are rejected (`too_large`); level surfaces up to this size are faces of objects.
  double max_depth_m = 4.0;            ///< Farther readings are not looked at.
  int max_segments = 128;              ///< The largest are kept.
};

template <class Visitor>
void visit_fields(SegmentationOptions& o, Visitor&& field) {
  field("plane_inlier_m", o.plane_inlier_m, 0.001, 0.05);
  field("cluster_tolerance_m", o.cluster_tolerance_m, 0.001, 0.1);
  field("edge_margin_m", o.edge_margin_m, 0.0, 0.2);
  field("min_points", o.min_points, 10, 100'000);
  field("min_height_m", o.min_height_m, 0.0, 0.2);
  field("max_height_m", o.max_height_m, 0.02, 3.0);
  field("max_size_m", o.max_size_m, 0.02, 3.0);
  field("max_depth_m", o.max_depth_m, 0.2, 30.0);
  field("max_segments", o.max_segments, 1, 1000);
}

/// Finds support planes and the objects on them (P3). `up_camera` from an accelerometer, `last` the plane of the frame
/// before (tried first). `mask`: non-empty = the user's mask, whose pixels become the one segment. No plane and no object are results.
Segments segment_cloud(const OrganizedCloud& cloud, const SegmentationOptions& options = {},
                       const std::optional<Eigen::Vector3d>& up_camera = std::nullopt, const SupportPlane* last = nullptr,
                       const Image<std::uint8_t>& mask = {});

}  // namespace gfp
