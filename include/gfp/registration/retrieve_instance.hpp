#pragma once

#include <cstdint>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/recognition/hypothesis.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

struct RetrieveInstanceOptions {
  int instances = 12;       ///< Per class: its mean, and members drawn from its sizes and modes.
  int yaw_steps = 24;
  int icp_iterations = 30;
  std::uint64_t seed = 1;   ///< Of the members that are drawn: the "training set".
};

template <class Visitor>
void visit_fields(RetrieveInstanceOptions& o, Visitor&& field) {
  field("instances", o.instances, 1, 1000);
  field("yaw_steps", o.yaw_steps, 1, 360);
  field("icp_iterations", o.icp_iterations, 0, 1000);
  field("seed", o.seed, std::uint64_t{0}, std::uint64_t{1} << 53U);
}

/// Retrieval instead of modelling (Tan08a, P31): the known member that lies nearest to the cluster, moved onto it by ICP and not deformed.
///
/// Every member of every hypothesis is set on the support in its likely stable poses, its seen side's centre on the cluster's, and turned
/// about up; the least mean distance from the cluster's points to it wins.
/// @return the winner; `cost` is the mean squared distance after ICP, m^2. No hypotheses or fewer than 3 object points: a null primitive.
Placement retrieve_instance(const ObjectView& view, const std::vector<Hypothesis>& hypotheses, const RetrieveInstanceOptions& options = {});

}  // namespace gfp
