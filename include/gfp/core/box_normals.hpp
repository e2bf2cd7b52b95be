#pragma once

#include "gfp/core/image.hpp"

namespace gfp {

/// A depth map with its rays, as raw planes: z in metres (NaN where there is no reading) and x = ray_x z, y = ray_y z.
struct DepthPlanes {
  int width = 0, height = 0;
  const float *x = nullptr, *y = nullptr, *z = nullptr;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  bool undistorted = true;  ///< ray_x = (u - cx) / fx and ray_y = (v - cy) / fy; else the rays' steps are taken from x, y and z.
};

struct BoxNormalsOptions {
  int radius_px = 4;             ///< Half side of the box, [kMinBoxRadius, kMaxBoxRadius].
  float max_depth_step = 0.02F;  ///< Readings that differ from the centre's by more than this share of its depth are another surface.
  bool whole_boxes_only = false; ///< NaN instead of the second way (below): blind at edges and holes.
};
inline constexpr int kMinBoxRadius = 2, kMaxBoxRadius = 20;

/// Unit normals towards the camera for the pixels of `rect`, written to the planes nx, ny, nz (width x height of the whole
/// image); NaN where the pixel has no reading or its surface fewer than six readings in the box. Readings nearer than 1/16 m are none.
///
/// A plane is linear in inverse depth, 1/z = a ray_x + b ray_y + c, with the normal along -(a, b, c). Where the box holds one
/// whole surface, the slopes are least squares over all its pixels, by sums that slide down the image (moments of 1/z; the pixel
/// coordinates' own moments are constants). Elsewhere they are least squares over those of 5 x 5 pixels, spread over the box, that
/// have a reading within `max_depth_step` of the centre's depth. All sums are of integers (1/z in steps of 2^-19 per metre at the
/// usual radius): exact, and the same for every rectangle around a pixel.
void box_normals(const DepthPlanes& depth, const BoxNormalsOptions& options, const PixelRect& rect, float* nx, float* ny, float* nz);

}  // namespace gfp
