#pragma once

#include <vector>

#include "gfp/segmentation/segment_cloud.hpp"
#include "segmentation/contacts.hpp"
#include "segmentation/pieces.hpp"
#include "segmentation/supports.hpp"

namespace gfp {

/// Puts pieces together into objects, by what an object is on a table. Pieces belong together where
/// - their surfaces continue each other over much of their boundary, or one is a mere fragment at the other;
/// - one lies inside the other's rim: behind it, as high, and hollow (bowls, mugs), or enclosed by it;
/// - one hangs in the air beside the other (handles, caps, spouts): it does not reach the support, nothing hides its foot,
///   and it does not stand on a level top of the other;
/// - a nearer object divides one surface into two.
/// Otherwise a valley or a step between them divides two objects that touch. `supports`: of each piece, null where unknown.
/// Returns the object of every piece, numbered from 0 in the order of first pieces.
std::vector<int> assemble(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid,
                          const std::vector<Contact>& contacts, const std::vector<const FlatSurface*>& supports, const SegmentationOptions& options);

}  // namespace gfp
