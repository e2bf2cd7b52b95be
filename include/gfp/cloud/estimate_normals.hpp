#pragma once

#include <vector>

#include "gfp/cloud/organized_cloud.hpp"

namespace gfp {

struct EstimateNormalsOptions {
  int radius_px = 4;              ///< Half side of the box over which a plane is fitted.
  double max_depth_step = 0.02;   ///< Neighbours that differ by more than this share of the depth are another surface.
};

template <class Visitor>
void visit_fields(EstimateNormalsOptions& o, Visitor&& field) {
  field("radius_px", o.radius_px, 2, 20);
  field("max_depth_step", o.max_depth_step, 0.001, 0.2);
}

/// Normals of the pixels inside `region` (of the whole image where `region` is empty), towards the camera.
NormalMap estimate_normals(const OrganizedCloud& cloud, const EstimateNormalsOptions& options = {}, const std::vector<PixelRect>& region = {});

}  // namespace gfp
