#pragma once

#include <Eigen/Core>
#include <vector>

#include "segmentation/pieces.hpp"

namespace gfp {

/// How two pieces meet in the image: pairs of pixels on either side, side by side or with nothing but missing readings between.
struct Contact {
  int first = 0, second = 0;     ///< Pieces; first < second.
  int pairs = 0;
  int touching = 0;              ///< Pairs whose points are no farther apart than the cluster tolerance.
  int concave = 0;               ///< Touching pairs at which the surfaces form a valley.
  int first_nearer = 0, second_nearer = 0;  ///< Pairs with a step of depth, by which side is in front.
  int first_above = 0, second_above = 0;    ///< Touching pairs where that side rises from the other's level surface (it may rest on it).
  double gap_left_m = 0, gap_right_m = 0;   ///< Smallest distance in the outer eighths of the boundary, by image column.
  double gap_middle_m = 0;                  ///< Median distance between them.
  double gap_m = 0;                         ///< Smallest distance.

  // Of a piece `p` that is one of the two.
  bool is_of(int p) const { return p == first || p == second; }
  int other(int p) const { return p == first ? second : first; }
  int nearer(int p) const { return p == first ? first_nearer : second_nearer; }  ///< Pairs at which it is in front.
  int above(int p) const { return p == first ? first_above : second_above; }
  int front() const { return first_nearer > second_nearer ? first : second; }    ///< The one that is in front at more pairs.
};

/// Contacts of all pieces, ordered by (first, second). `up` points away from the support.
std::vector<Contact> find_contacts(const OrganizedCloud& cloud, const PieceMap& map, const std::vector<std::uint8_t>& valid,
                                   double tolerance_m, const Eigen::Vector3d& up);

}  // namespace gfp
