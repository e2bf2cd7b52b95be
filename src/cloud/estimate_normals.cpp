#include "gfp/cloud/estimate_normals.hpp"

#include <limits>

#include "gfp/core/box_normals.hpp"

namespace gfp {

NormalMap estimate_normals(const OrganizedCloud& cloud, const EstimateNormalsOptions& options, const std::vector<PixelRect>& region) {
  NormalMap normals{cloud.width, cloud.height, {}, {}, {}};
  for (auto* plane : {&normals.x, &normals.y, &normals.z}) plane->assign(cloud.size(), std::numeric_limits<float>::quiet_NaN());
  const DepthPlanes depth{cloud.width, cloud.height, cloud.x.data(), cloud.y.data(), cloud.z.data(),
                          cloud.camera.fx, cloud.camera.fy, cloud.camera.cx, cloud.camera.cy, cloud.camera.distortion == DistortionModel::kNone};
  const BoxNormalsOptions box{options.radius_px, static_cast<float>(options.max_depth_step)};
  if (region.empty()) box_normals(depth, box, {0, 0, cloud.width, cloud.height}, normals.x.data(), normals.y.data(), normals.z.data());
  for (const PixelRect& rect : region) box_normals(depth, box, rect, normals.x.data(), normals.y.data(), normals.z.data());
  return normals;
}

}  // namespace gfp
