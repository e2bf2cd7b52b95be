#pragma once

#include <Eigen/Core>
#include <vector>

namespace gfp {

/// How a body comes to rest that is held with orientation `R_world_body` above a table and let go gently: it tips about the
/// vertex or edge it stands on, lowering its centre of mass, until that lies above the polygon it stands on.
/// Quasi-static (no swing, no slide). Stops after 1000 tips, as a finely tessellated ball may need. O(vertices) a tip.
Eigen::Matrix3d settle(const std::vector<Eigen::Vector3d>& vertices_body, const Eigen::Vector3d& centre_of_mass_body,
                       Eigen::Matrix3d R_world_body);

}  // namespace gfp
