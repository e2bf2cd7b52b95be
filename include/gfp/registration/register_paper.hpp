#pragma once

#include "gfp/memory/object_view.hpp"
#include "gfp/recognition/hypothesis.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

struct PaperRegistrationOptions {
  double rotation_step_rad = 0.2618;  ///< Of the search about the three axes: 15 degrees (P13).
  int halvings = 3;                   ///< The best rotations are searched around with half the step, so many times.
  int keep = 4;                       ///< Rotations that are searched around.
  int icp_iterations = 30;
};

template <class Visitor>
void visit_fields(PaperRegistrationOptions& o, Visitor&& field) {
  field("rotation_step_rad", o.rotation_step_rad, 0.05, 1.0);
  field("halvings", o.halvings, 0, 8);
  field("keep", o.keep, 1, 100);
  field("icp_iterations", o.icp_iterations, 0, 1000);
}

/// The paper's registration, literally (P11-P15): scale by the circumscribed spheres, translation by the centres of mass, rotation
/// about three axes stepped through for the least sum of distances from the cluster's points to the nearest primitive points, then
/// ICP (PCL's), cluster to primitive. Knows no table: the object may come out tilted or sunk in.
/// @return scale is the same along all axes and keeps the class's typical proportions; `cost` is the mean squared distance over the
///         squared radius. With fewer than 3 object points the primitive at its typical size where the points' centre is, unconverged.
/// Cost: about 50 ms and ICP's 20 to 500 ms: every point of the cluster takes part (P9).
Placement register_paper(const ObjectView& view, const Hypothesis& hypothesis, const PaperRegistrationOptions& options = {});

}  // namespace gfp
