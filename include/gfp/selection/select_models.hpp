#pragma once

#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/selection/object_estimate.hpp"

namespace gfp {

/// One fit with what was believed of its class before.
struct Candidate {
  FittedModel model;
  double log_prior = 0;  ///< Of its class; of a model without one: beyond what "none of the classes" is always worth.
};

struct SelectionOptions {
  double context_weight = 0.0;   ///< Of co-occurrence and relative size over the scene; 0 switches it off.
};

template <class Visitor>
void visit_fields(SelectionOptions& o, Visitor&& field) {
  field("context_weight", o.context_weight, 0.0, 10.0);
}

/// Whether a fit without a class could still matter beside these: even a flawless one pays for its freedom. True where there are none.
bool unknown_may_win(const std::vector<Candidate>& candidates);

/// Which of its candidates each object is, decided jointly. `candidates[i]` belongs to `views[i]` and is not empty.
std::vector<ObjectEstimate> select_models(const std::vector<ObjectView>& views, std::vector<std::vector<Candidate>> candidates,
                                          const SelectionOptions& options = {});

}  // namespace gfp
