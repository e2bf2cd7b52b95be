#pragma once

#include <span>
#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/recognition/hypothesis.hpp"
#include "gfp/registration/placement.hpp"

namespace gfp {

struct RegistrationOptions {
  int yaw_steps = 12;          ///< Of the search, halved beside the best; fewer where the class is symmetric.
  int keep = 3;                ///< Placements, over all hypotheses, that are refined fully.
  int max_iterations = 12;     ///< Of the refinement.
  int sample_pixels = 700;     ///< Object pixels used in the refinement.
};

template <class Visitor>
void visit_fields(RegistrationOptions& o, Visitor&& field) {
  field("yaw_steps", o.yaw_steps, 4, 360);
  field("keep", o.keep, 1, 10);
  field("max_iterations", o.max_iterations, 1, 100);
  field("sample_pixels", o.sample_pixels, 100, 100'000);
}

/// The `robust` registration (ALGORITHM 1): visible part against visible part in the image, all hypotheses of one object against each
/// other. Best placement first, at most `keep`; hypotheses that fall far behind have none. Empty only where `hypotheses` is.
std::vector<Placement> register_hypotheses(const ObjectView& view, std::span<const Hypothesis> hypotheses, const RegistrationOptions& options = {});

/// The same for one class. Never empty.
std::vector<Placement> register_primitive(const ObjectView& view, const Hypothesis& hypothesis, const RegistrationOptions& options = {});

}  // namespace gfp
