#pragma once

#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"
#include "gfp/registration/placement.hpp"
#include "modelling/surface_targets.hpp"

namespace gfp {

/// 1-sigma of every vertex along its normal, metres (ALGORITHM 2). Seen vertices: sensor noise averaged over their readings, and a
/// bias that no averaging removes. The rest: the posterior of pose, size and modes carried to the vertex, and what the class's modes
/// do not explain, which grows with the distance to the nearest seen vertex.
std::vector<float> vertex_sigma(const ObjectView& view, const Placement& placement, const SurfaceTargets& data, const std::vector<std::uint8_t>& states,
                                const std::vector<Eigen::Vector3d>& vertices_support, const std::vector<Eigen::Vector3d>& normals_support);

}  // namespace gfp
