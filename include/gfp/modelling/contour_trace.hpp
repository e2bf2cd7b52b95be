#pragma once

#include <vector>

namespace gfp {

/// One iteration of an active contour that moves control points step by step (P18-P27), over all of them.
struct ContourStep {
  double continuity = 0, curvature = 0;  ///< Internal energies behind their 0/1 gates, in units of the gates' thresholds.
  double external = 0;                   ///< Squared distances left to the places that the scene's density asks for, squared rest edges.
  int settled = 0;                       ///< Controls that have come to their place.
  int moved = 0;                         ///< Vertices, control or regular, that are off their first place by now.
  double energy() const { return continuity + curvature + external; }
};

/// How such a contour ran (Fig. 6).
struct ContourTrace {
  int controls = 0;                ///< Points that data may move (P7).
  int frozen = 0;                  ///< Of these: no data near enough, they keep their first place.
  int moved_controls = 0, moved_regulars = 0;
  std::vector<ContourStep> steps;  ///< The first is the start.
};

}  // namespace gfp
