#pragma once

#include <optional>
#include <vector>

#include "gfp/segmentation/segment_cloud.hpp"
#include "segmentation/ground.hpp"

namespace gfp {

/// A plane as the per-pixel loops need it: height(p) = up . p + camera_height_m - ground(pixel); a reading with
/// |height| <= band(z) lies on it.
struct FlatSurface {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  double camera_height_m = 0;
  double band_m = 0, band_per_m2 = 0;
  Ground ground;
  std::vector<Eigen::Vector3d> edges;  ///< Inner unit normals of the outline's edges, camera frame, in the plane,
  std::vector<double> edge_offsets_m;  ///< and edge . p + offset >= 0 inside. Counter-clockwise about `up`.
  std::vector<Eigen::Vector3d> corners;  ///< Of the outline, on the plane, camera frame.
  /// Above the plain plane, and above the surface as it is warped.
  double plane_height(const OrganizedCloud& cloud, std::int32_t pixel) const {
    return up.dot(cloud.point(static_cast<std::size_t>(pixel)).cast<double>()) + camera_height_m;
  }
  double height(const OrganizedCloud& cloud, std::int32_t pixel) const {
    return plane_height(cloud, pixel) - static_cast<double>(ground.at(pixel % cloud.width, pixel / cloud.width));
  }
  double band(double z) const { return band_m + band_per_m2 * z * z; }
  /// Distance to the nearest edge of the outline's prism, positive inside.
  double inside(const Eigen::Vector3d& p) const;
};

/// The support planes with their form for the pixel loops (same order), and large planes that carry nothing: walls.
struct Supports {
  std::vector<SupportPlane> planes;
  std::vector<FlatSurface> surfaces;
  std::vector<FlatSurface> walls;
};

/// Which flat parts carry objects. Up is `up_camera` where it is known; else the evidence decides: surfaces that the camera
/// looks down on (normal within 75 deg of the image's up) before those it faces squarely. Parallel surfaces smaller than an
/// object and not far above another support are faces of objects. `last`, where given, is looked for as well.
Supports find_supports(const OrganizedCloud& cloud, const SegmentationOptions& options,
                       const std::optional<Eigen::Vector3d>& up_camera, const SupportPlane* last);

}  // namespace gfp
