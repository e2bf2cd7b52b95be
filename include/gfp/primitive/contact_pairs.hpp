#pragma once

#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/primitive/primitive.hpp"

namespace gfp {

struct ContactPairOptions {
  int pairs = 256;
  int max_rays = 4096;
  double cone_rad = 0.61;         ///< Half angle between the line of the contacts and the far normal: a generous friction cone.
  double min_width_m = 0.0005;    ///< Closer contacts are rounding.
  double max_width_m = 0.16;      ///< No gripper we know opens wider.
  std::uint64_t seed = 7;
};

/// Antipodal surface points (ALGORITHM 5) without a gripper: from points even by area, a ray against the normal; every surface it
/// leaves inside the cone gives a pair, so that a mug offers its wall (rim grasps) and its whole width.
std::vector<ContactPair> sample_contact_pairs(const TriangleMesh& mesh, const ContactPairOptions& options = {});

}  // namespace gfp
