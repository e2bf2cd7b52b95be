#include "gfp/selection/select_models.hpp"

#include <algorithm>
#include <cmath>

#include "gfp/memory/image_score.hpp"

namespace gfp {
namespace {

constexpr double kFreedomPenalty = 0.5 * 4.1;  ///< Half log of kScorePixels for every free parameter (BIC).
constexpr double kDescriptorTrust = 0.3;  ///< Share of the descriptors' log likelihood that is kept: they are correlated, and the fit saw more.

// Calibrated on 606 views of held-out family members: the mean probability of what was chosen is .90, and so is the share that was right.
constexpr double kTemperature = 3.0;      ///< Log odds are that many times too sure of themselves.
constexpr double kNotAmongThem = 0.08;    ///< How often the true class is none of the candidates.

constexpr int kUnknownFreedoms = 5;       ///< Of a superquadric: sizes and exponents; the pose is everybody's.
constexpr double kLeastCost = 0.2;        ///< Of the best fits of real objects: noise, ragged edges.
constexpr double kNegligibleOdds = 3.0;   ///< Log odds beyond which an alternative does not matter.

/// Parameters that no prior ties down; a class's size and modes pay through their Mahalanobis distance.
int free_parameters(const FittedModel& model) { return model.primitive ? 0 : kUnknownFreedoms; }

double log_evidence(const Candidate& candidate, const SelectionOptions& options) {
  const FitEvidence& evidence = candidate.model.evidence;
  const double prior = candidate.model.primitive ? kDescriptorTrust * candidate.log_prior : options.unknown_log_prior + candidate.log_prior;
  return prior - kScorePixels * evidence.cost - 0.5 * evidence.mahalanobis * evidence.mahalanobis -
         kFreedomPenalty * free_parameters(candidate.model);
}

ObjectEstimate select_one(const ObjectView& view, std::vector<Candidate> candidates, const SelectionOptions& options) {
  ObjectEstimate estimate;
  estimate.id = view.id;
  estimate.segment = view.segment;
  std::size_t best = 0;
  std::vector<double> evidences;
  for (const auto& candidate : candidates) {
    evidences.push_back(log_evidence(candidate, options));
    if (evidences.back() > evidences[best]) best = evidences.size() - 1;
  }
  double total = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const double odds = std::exp((evidences[k] - evidences[best]) / kTemperature);
    auto& of_class = estimate.class_probabilities[candidates[k].model.class_name];
    total += std::max(0.0, odds - of_class);
    of_class = std::max(of_class, odds);  // a class is as probable as its best placement
  }
  for (auto& [name, probability] : estimate.class_probabilities) probability *= (1 - kNotAmongThem) / total;
  estimate.class_probabilities["unknown"] += kNotAmongThem;
  estimate.model = std::move(candidates[best].model);
  return estimate;
}

}  // namespace

bool unknown_may_win(const std::vector<Candidate>& candidates, const SelectionOptions& options) {
  const double flawless = options.unknown_log_prior - kScorePixels * kLeastCost - kFreedomPenalty * kUnknownFreedoms;
  return std::none_of(candidates.begin(), candidates.end(), [&](const Candidate& c) { return log_evidence(c, options) > flawless + kNegligibleOdds; });
}

std::vector<ObjectEstimate> select_models(const std::vector<ObjectView>& views, std::vector<std::vector<Candidate>> candidates,
                                          const SelectionOptions& options) {
  std::vector<ObjectEstimate> estimates;
  for (std::size_t i = 0; i < views.size(); ++i) estimates.push_back(select_one(views[i], std::move(candidates[i]), options));
  return estimates;
}

}  // namespace gfp
