#include "gfp/selection/select_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/box_model.hpp"

namespace gfp {
namespace {

Candidate of_class(const std::string& name, double cost, double mahalanobis = 0, double log_prior = 0) {
  Candidate candidate{test::box_model("gfp_robust", name, {0.1, 0.1, 0.1}, cost), log_prior};
  candidate.model.primitive = std::make_shared<const Primitive>();
  candidate.model.evidence.mahalanobis = mahalanobis;
  return candidate;
}

Candidate of_no_class(double cost) { return {test::box_model("superquadric", "unknown", {0.1, 0.1, 0.1}, cost), 0}; }

ObjectEstimate decide(std::vector<Candidate> candidates, const SelectionOptions& options = {}) {
  ObjectView view;
  view.id = 7;
  return select_models({view}, {std::move(candidates)}, options).front();
}

TEST(SelectModels, TheBetterFitWinsAndTheProbabilitiesSumToOne) {
  const ObjectEstimate estimate = decide({of_class("mug", 0.30), of_class("cup", 0.33)});
  EXPECT_EQ(estimate.id, 7U);
  EXPECT_EQ(estimate.model.class_name, "mug");
  double sum = 0;
  for (const auto& [name, probability] : estimate.class_probabilities) sum += probability;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_TRUE(estimate.class_probabilities.contains("unknown"));
  EXPECT_GT(estimate.class_probabilities.at("cup"), 0.05);
}

// Nothing is certain: even a single candidate may be none of the truth.
TEST(SelectModels, ProbabilitiesAreNoSurerThanTheyAreRight) {
  const auto known = [](double cost) { return 0.95 * (0.15 + 0.85 / (1 + std::pow(cost / 0.65, 3))); };
  for (const double cost : {0.1, 0.3, 0.65, 1.4}) {
    EXPECT_NEAR(decide({of_class("mug", cost)}).class_probabilities.at("mug"), known(cost), 1e-12) << cost;
    EXPECT_NEAR(decide({of_class("mug", cost)}).class_probabilities.at("unknown"), 1 - known(cost), 1e-12) << cost;
  }
  const auto even = decide({of_class("mug", 0.3), of_class("cup", 0.3)}).class_probabilities, worse = decide({of_class("mug", 0.3), of_class("cup", 0.4)}).class_probabilities;
  EXPECT_NEAR(even.at("mug"), even.at("cup"), 1e-12);
  EXPECT_GT(worse.at("mug"), even.at("mug"));
  EXPECT_NEAR(worse.at("cup") / worse.at("mug"), std::exp(-0.1 * 60 / 3.0) * known(0.4) / known(0.3), 1e-9);  // 60 readings count, log odds are divided by 3
}

TEST(SelectModels, AnUnlikelyShapeOfAClassPaysForIt) { EXPECT_EQ(decide({of_class("jar", 0.30, 8), of_class("can", 0.35, 1)}).model.class_name, "can"); }

TEST(SelectModels, WhatDescriptorsSaidBreaksTies) { EXPECT_EQ(decide({of_class("jar", 0.3, 0, -5), of_class("can", 0.3, 0, -0.1)}).model.class_name, "can"); }

// A superquadric is more flexible than any class: it has to fit clearly better.
TEST(SelectModels, UnknownWinsOnlyByAClearlyBetterFit) {
  EXPECT_EQ(decide({of_class("can", 0.45), of_no_class(0.35)}).model.class_name, "can");
  EXPECT_EQ(decide({of_class("can", 1.20), of_no_class(0.35)}).model.class_name, "unknown");
  EXPECT_EQ(decide({of_class("can", 0.45), of_no_class(0.10)}, SelectionOptions{.unknown_log_prior = 0, .context = {}}).model.class_name, "unknown");
}

// What is spared is what could not have won: of all fits without a class, none at the least cost beats these.
TEST(SelectModels, SparesUnknownOnlyWhereItCannotWin) {
  EXPECT_TRUE(unknown_may_win({}));
  for (double cost = 0.1; cost < 1.5; cost += 0.05) {
    const std::vector<Candidate> candidates{of_class("can", cost)};
    if (!unknown_may_win(candidates)) EXPECT_EQ(decide({candidates.front(), of_no_class(0.2)}).model.class_name, "can") << cost;
    else EXPECT_GT(cost, 0.3);
  }
}

/// Two objects: what the first is, decided beside a sure `neighbour`.
ObjectEstimate beside(const std::string& neighbour, std::vector<Candidate> candidates, const ContextOptions& context = {}) {
  SelectionOptions options;
  options.context = context;
  return select_models({ObjectView{}, ObjectView{}}, {std::move(candidates), {of_class(neighbour, 0.3)}}, options).front();
}

// P4: what else stands there decides between two that fit alike, and never against the fit.
TEST(Context, TheSceneBreaksTies) {
  const ContextOptions strong{.together = 3, .apart = -3, .groups = {"mug bowl plate", "ball toy_car"}};
  const std::vector<Candidate> round{of_class("ball", 0.30), of_class("bowl", 0.30)};
  EXPECT_EQ(beside("plate", round, strong).model.class_name, "bowl");
  EXPECT_EQ(beside("toy_car", round, strong).model.class_name, "ball");
  EXPECT_EQ(beside("plate", {of_class("ball", 0.30), of_class("bowl", 0.80)}, strong).model.class_name, "ball");
  EXPECT_GT(beside("plate", round, strong).class_probabilities.at("bowl"), beside("plate", round, {}).class_probabilities.at("bowl"));
}

TEST(Context, SaysWhatItAdded) {
  const ContextOptions context{.together = 2, .size_correlation = 0, .groups = {"mug plate"}};
  const double sure = decide({of_class("plate", 0.3)}).class_probabilities.at("plate");
  EXPECT_NEAR(beside("plate", {of_class("mug", 0.3)}, context).model.evidence.context, 2 * sure, 1e-12) << "the neighbour is no surer than that";
  EXPECT_EQ(beside("plate", {of_class("mug", 0.3)}, {.weight = 0}).model.evidence.context, 0);
  EXPECT_EQ(decide({of_class("mug", 0.3)}).model.evidence.context, 0) << "alone";
  EXPECT_EQ(beside("plate", {of_no_class(0.2)}, context).model.evidence.context, 0) << "of no class";
  EXPECT_EQ(beside("gadget", {of_class("mug", 0.3)}, context).model.evidence.context, 0) << "nothing is known of gadgets";
}

/// A model whose three log sizes are `deviation` standard deviations of their mean above its class's.
FittedModel sized(double deviation) {
  FittedModel model = of_class("mug", 0.3).model;
  auto primitive = std::make_shared<Primitive>();
  primitive->log_size_covariance = 0.04 * Eigen::Matrix3d::Identity();  // of the mean: 0.2 / sqrt(3)
  model.primitive = primitive;
  model.size_m = Eigen::Vector3d::Constant(std::exp(deviation * 0.2 / std::sqrt(3.0)));
  return model;
}

// Log ratio of the correlated to the independent normal density, as a table of normals has it.
TEST(Context, RelativeSizesAreACorrelatedPair) {
  const Context context({.together = 0, .apart = 0, .size_correlation = 0.5});
  const auto log_density = [](double a, double b, double r) { return -0.5 * std::log(1 - r * r) - (a * a - 2 * r * a * b + b * b) / (2 * (1 - r * r)); };
  for (const double a : {-2.0, 0.0, 1.5})
    for (const double b : {-1.0, 0.5, 2.0}) EXPECT_NEAR(context.log_odds(sized(a), sized(b)), log_density(a, b, 0.5) - log_density(a, b, 0), 1e-9) << a << " " << b;
  EXPECT_GT(context.log_odds(sized(2), sized(2)), 0) << "a set of large things";
  EXPECT_LT(context.log_odds(sized(2), sized(-2)), 0);
}

// Two undecided things lift each other: neither is sure, both become surer.
TEST(Context, UndecidedThingsDecideEachOther) {
  SelectionOptions options;
  options.context = {.together = 3, .apart = -3, .rounds = 10, .groups = {"mug bowl", "ball toy_car"}};
  const std::vector<std::vector<Candidate>> both{{of_class("ball", 0.30), of_class("bowl", 0.302)}, {of_class("toy_car", 0.36), of_class("mug", 0.30)}};
  const auto estimates = select_models({ObjectView{}, ObjectView{}}, both, options);
  EXPECT_EQ(estimates[0].model.class_name, "bowl");
  EXPECT_EQ(estimates[1].model.class_name, "mug");
}

}  // namespace
}  // namespace gfp
