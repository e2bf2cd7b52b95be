#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "gfp/core/image.hpp"
#include "gfp/core/transform.hpp"

namespace gfp {

/// A flat surface that carries objects. Support frame: z up (away from the surface), origin on it.
struct SupportPlane {
  Transform T_camera_support = Transform::Identity();
  std::vector<Eigen::Vector2d> polygon;  ///< Convex outline of the seen surface in the support frame's xy, metres, counter-clockwise.
  double rms_m = 0;                      ///< Of the inliers' distances.
  int inliers = 0;                       ///< Pixels.
};

/// The pixels of one object candidate (P3), with what its outline tells about the part that is not seen.
struct Segment {
  std::vector<std::int32_t> pixels;  ///< Row-major indices v * width + u, ascending.
  PixelRect bbox;
  int support = -1;                  ///< Index into Segments::planes; -1 where no plane is known.
  bool touches_border = false;       ///< Cut by the image border or the cropped region: it may go on outside.
  bool occluded = false;             ///< Something nearer abuts its outline: part of it may be hidden.
  bool top_cut = false;              ///< The border or occluder is where its highest points are: height is a lower bound.
  double height_m = 0;               ///< 99.5 % quantile above the support plane.
};

/// A candidate that was not taken on, and why: `too_small`, `too_large`, `too_flat`, `outside_workspace`, `below_support`...
struct RejectedSegment {
  int pixels = 0;
  std::string reason;
};

struct Segments {
  int width = 0, height = 0;
  std::vector<SupportPlane> planes;         ///< The one that carries most object pixels first, then by size; may be empty (a result).
  std::vector<Segment> segments;            ///< By their first pixel, ascending.
  std::vector<RejectedSegment> rejected;
  /// One per pixel: -1 unassigned, 0.. = index into segments, kPlaneLabel - k = lies on plane k.
  Image<std::int32_t> labels;
  static constexpr std::int32_t kUnassigned = -1;
  static constexpr std::int32_t kPlaneLabel = -10;
};

}  // namespace gfp
