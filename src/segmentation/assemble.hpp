#pragma once

#include <vector>

#include "gfp/segmentation/segment_cloud.hpp"
#include "segmentation/contacts.hpp"
#include "segmentation/pieces.hpp"
#include "segmentation/supports.hpp"

namespace gfp {

/// Puts pieces together into objects, by what an object is on a table. Pieces belong together where
/// - their surfaces continue each other over much of their boundary, or one is a mere fragment at the other;
/// - one lies inside the other's rim: behind it, as high, and hollow (bowls, mugs), or enclosed by it, or seen through it (jugs, vases);
/// - one is the outer wall below the other's flared rim;
/// - one hangs in the air beside the other (handles, caps, spouts): it does not reach the support, nothing hides its foot,
///   and it does not stand on a level top of the other; or it is borne by what stands below its middle (a drill's body on its grip);
/// - a nearer object divides one surface into two.
/// Otherwise a valley or a step between them divides two objects that touch. `supports`: of each piece, null where unknown. `up`: away from the support.
/// Returns the object of every piece, numbered from 0 in the order of first pieces.
std::vector<int> assemble(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid,
                          const std::vector<Contact>& contacts, const std::vector<const FlatSurface*>& supports, const Eigen::Vector3d& up, const SegmentationOptions& options);

}  // namespace gfp
