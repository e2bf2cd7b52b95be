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
  EXPECT_NEAR(decide({of_class("mug", 0.3)}).class_probabilities.at("mug"), 0.92, 1e-12);
  EXPECT_NEAR(decide({of_class("mug", 0.3)}).class_probabilities.at("unknown"), 0.08, 1e-12);
  const auto even = decide({of_class("mug", 0.3), of_class("cup", 0.3)}).class_probabilities, worse = decide({of_class("mug", 0.3), of_class("cup", 0.4)}).class_probabilities;
  EXPECT_NEAR(even.at("mug"), even.at("cup"), 1e-12);
  EXPECT_GT(worse.at("mug"), even.at("mug"));
  EXPECT_NEAR(worse.at("cup") / worse.at("mug"), std::exp(-0.1 * 60 / 3.0), 1e-9);  // 60 readings count, log odds are divided by 3
}

TEST(SelectModels, AnUnlikelyShapeOfAClassPaysForIt) { EXPECT_EQ(decide({of_class("jar", 0.30, 8), of_class("can", 0.35, 1)}).model.class_name, "can"); }

TEST(SelectModels, WhatDescriptorsSaidBreaksTies) { EXPECT_EQ(decide({of_class("jar", 0.3, 0, -5), of_class("can", 0.3, 0, -0.1)}).model.class_name, "can"); }

// A superquadric is more flexible than any class: it has to fit clearly better.
TEST(SelectModels, UnknownWinsOnlyByAClearlyBetterFit) {
  EXPECT_EQ(decide({of_class("can", 0.45), of_no_class(0.35)}).model.class_name, "can");
  EXPECT_EQ(decide({of_class("can", 1.20), of_no_class(0.35)}).model.class_name, "unknown");
  EXPECT_EQ(decide({of_class("can", 0.45), of_no_class(0.10)}, {.unknown_log_prior = 0}).model.class_name, "unknown");
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

}  // namespace
}  // namespace gfp
