#pragma once

#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/selection/context.hpp"
#include "gfp/selection/object_estimate.hpp"

namespace gfp {

/// One fit with what was believed of its class before.
struct Candidate {
  FittedModel model;
  double log_prior = 0;  ///< Of its class; of a model without one: beyond what "none of the classes" is always worth.
};

struct SelectionOptions {
  double unknown_log_prior = -8.0;  ///< Natural log of how often a thing is none of the classes; lower: named more readily.
  ContextOptions context;
};

template <class Visitor>
void visit_fields(SelectionOptions& o, Visitor&& field) {
  field("unknown_log_prior", o.unknown_log_prior, -100.0, 0.0);
  field.section("context", o.context);
}

/// Whether a fit without a class could still matter beside these: even a flawless one pays for its freedom. True where there are none.
bool unknown_may_win(const std::vector<Candidate>& candidates, const SelectionOptions& options = {});

/// Which of its candidates each object is, decided jointly: every object weighs its candidates by how they go with what the others probably
/// are (mean field). `candidates[i]` belongs to `views[i]` and is not empty. Class probabilities are
/// calibrated: of what is .9 sure, nine of ten are right; `unknown` also holds the chance that none of the candidates is, which grows with what
/// the fit costs. The model is the best one even where `unknown` is the likeliest: its shape is the best there is.
std::vector<ObjectEstimate> select_models(const std::vector<ObjectView>& views, std::vector<std::vector<Candidate>> candidates,
                                          const SelectionOptions& options = {});

}  // namespace gfp
