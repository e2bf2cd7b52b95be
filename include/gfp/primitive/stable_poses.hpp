#pragma once

#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

struct StablePoseOptions {
  double upright_share = 0.75;   ///< Prior of the canonical pose, where it is stable.
  double merge_angle_rad = 0.3;  ///< Faces that lean less against each other (modulo symmetry) are one pose.
  double min_probability = 0.02; ///< Less probable ones are left out.
  int max_poses = 6;
};

/// The ways in which a closed mesh rests on a plane: faces of its convex hull that hold the projected centre of mass
/// (of the homogeneous solid), merged where the symmetry or closeness makes them one. Poses other than the canonical one share what
/// `upright_share` leaves by the solid angle of their faces seen from the centre of mass. Names: upright, inverted, lying
/// (with the side that is down where several differ: lying_front for +x, lying_back, lying_side), tilted.
/// A mesh without volume gives the upright pose alone.
std::vector<StablePose> find_stable_poses(const TriangleMesh& mesh, const Symmetry& symmetry, const StablePoseOptions& options = {});

}  // namespace gfp
