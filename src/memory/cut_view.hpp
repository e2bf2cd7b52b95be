#pragma once

#include "gfp/memory/associate.hpp"

namespace gfp {

/// Everything of one segment's ObjectView that the frame alone tells: no id, no history, no neighbours.
/// `up_camera`: the best guess of up, unit, for a segment without a support plane.
ObjectView cut_view(const Segments& segments, int segment, const OrganizedCloud& cloud, const NormalMap& normals,
                    const Frame& frame, const Eigen::Vector3d& up_camera, const AssociateOptions& options);

}  // namespace gfp
