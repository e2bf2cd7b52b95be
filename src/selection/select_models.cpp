#include "gfp/selection/select_models.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "gfp/memory/image_score.hpp"

namespace gfp {
namespace {

constexpr double kFreedomPenalty = 0.5 * 4.1;  ///< Half log of kScorePixels for every free parameter (BIC).
constexpr double kDescriptorTrust = 0.3;  ///< Share of the descriptors' log likelihood that is kept: they are correlated, and the fit saw more.

constexpr double kTemperature = 3.0;      ///< Log odds are that many times too sure of themselves: calibrated on 606 views of held-out family members.

// How often the right class is among those that were fitted, by what the fit costs. Calibrated on 599 views of other family members, each with its
// class in the library and with it left out (which counts as 15 in 100).
constexpr double kAmongThem = 0.95;       ///< Of flawless fits.
constexpr double kDoubtfulCost = 0.65;    ///< About half of that...
constexpr double kLeastAmongThem = 0.15;  ///< ... of which so much is left of the worst: real things leave their class.

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

using PerCandidate = std::vector<std::vector<double>>;  // of each object

/// The chance that a fit of a class with this cost means that the thing is of one of the classes.
double share_of_known(const FittedModel& model) {
  const double ratio = model.evidence.cost / kDoubtfulCost;
  return model.primitive ? kAmongThem * (kLeastAmongThem + (1 - kLeastAmongThem) / (1 + ratio * ratio * ratio)) : 1.0;
}

/// Of each candidate, beside the best one.
std::vector<double> odds_of(const std::vector<double>& evidences) {
  const double best = *std::max_element(evidences.begin(), evidences.end());
  std::vector<double> odds;
  for (const double evidence : evidences) odds.push_back(std::exp((evidence - best) / kTemperature));
  return odds;
}

/// How sure an object is of each of its candidates; what is left of 1 is none of them.
std::vector<double> beliefs(const std::vector<Candidate>& candidates, const std::vector<double>& evidences) {
  std::vector<double> result = odds_of(evidences);
  const double total = std::accumulate(result.begin(), result.end(), 0.0);
  for (std::size_t k = 0; k < result.size(); ++k) result[k] *= share_of_known(candidates[k].model) / total;
  return result;
}

/// Mean log odds, over the other objects and what they may be, of each candidate.
PerCandidate context_of(const std::vector<std::vector<Candidate>>& candidates, const PerCandidate& evidences, const ContextOptions& options) {
  const Context context(options);
  PerCandidate odds;
  for (const auto& of_object : candidates) odds.emplace_back(of_object.size(), 0.0);
  if (candidates.size() < 2 || options.weight <= 0) return odds;
  for (int round = 0; round < options.rounds; ++round) {
    PerCandidate belief;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      std::vector<double> total = evidences[i];
      for (std::size_t k = 0; k < total.size(); ++k) total[k] += odds[i][k];
      belief.push_back(beliefs(candidates[i], total));
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      for (std::size_t k = 0; k < candidates[i].size(); ++k) {
        double sum = 0;
        for (std::size_t j = 0; j < candidates.size(); ++j)
          for (std::size_t l = 0; j != i && l < candidates[j].size(); ++l) sum += belief[j][l] * context.log_odds(candidates[i][k].model, candidates[j][l].model);
        odds[i][k] = sum / static_cast<double>(candidates.size() - 1);
      }
    }
  }
  return odds;
}

ObjectEstimate select_one(const ObjectView& view, std::vector<Candidate> candidates, const std::vector<double>& evidences, const std::vector<double>& context) {
  ObjectEstimate estimate;
  estimate.id = view.id;
  estimate.segment = view.segment;
  std::vector<double> totals = evidences;
  for (std::size_t k = 0; k < totals.size(); ++k) totals[k] += context[k];
  const auto best = static_cast<std::size_t>(std::max_element(totals.begin(), totals.end()) - totals.begin());
  const std::vector<double> odds = odds_of(totals);
  double total = 0;
  std::map<std::string, std::pair<double, double>> odds_and_share;  // a class is as probable as its best placement
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    auto& of_class = odds_and_share[candidates[k].model.class_name];
    total += std::max(0.0, odds[k] - of_class.first);
    if (odds[k] > of_class.first) of_class = {odds[k], share_of_known(candidates[k].model)};
  }
  double named = 0;
  for (const auto& [name, of_class] : odds_and_share) {
    const double probability = of_class.first / total * of_class.second;
    estimate.class_probabilities[name] = probability;
    named += probability;
  }
  estimate.class_probabilities["unknown"] += 1 - named;
  estimate.model = std::move(candidates[best].model);
  estimate.model.evidence.context = context[best];
  return estimate;
}

}  // namespace

bool unknown_may_win(const std::vector<Candidate>& candidates, const SelectionOptions& options) {
  const double flawless = options.unknown_log_prior - kScorePixels * kLeastCost - kFreedomPenalty * kUnknownFreedoms;
  return std::none_of(candidates.begin(), candidates.end(), [&](const Candidate& c) { return log_evidence(c, options) > flawless + kNegligibleOdds; });
}

std::vector<ObjectEstimate> select_models(const std::vector<ObjectView>& views, std::vector<std::vector<Candidate>> candidates,
                                          const SelectionOptions& options) {
  PerCandidate evidences;
  for (const auto& of_object : candidates) {
    evidences.emplace_back();
    for (const Candidate& candidate : of_object) evidences.back().push_back(log_evidence(candidate, options));
  }
  const PerCandidate context = context_of(candidates, evidences, options.context);
  std::vector<ObjectEstimate> estimates;
  for (std::size_t i = 0; i < views.size(); ++i) estimates.push_back(select_one(views[i], std::move(candidates[i]), evidences[i], context[i]));
  return estimates;
}

}  // namespace gfp
