// Held-out members of every family with free-form displacement, Kinect noise, the pipeline's own segmentation, against the
// committed figures of tests/guard/families.csv. A change that makes one worse fails; one that makes it better should raise it:
// the run prints the table as it is now.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>

#include "app/builtin_library.hpp"
#include "gfp/evaluation/run_evaluation.hpp"
#include "gfp/evaluation/summary.hpp"

namespace gfp {
namespace {

constexpr double kIouSlack = 0.03;       // of one family's median over six views: a handful of pixels decides
constexpr double kMeanIouSlack = 0.005;  // of the mean over all families

struct Figures {
  double iou_filled = 0, chamfer_mm = 0;
  int missed = 0;
};

std::map<std::string, Figures> committed_figures() {
  std::ifstream file(GFP_SOURCE_DIR "/tests/guard/families.csv");
  std::map<std::string, Figures> all;
  std::string line;
  std::getline(file, line);  // header
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string family, iou, chamfer, missed;
    std::getline(fields, family, ',');
    std::getline(fields, iou, ',');
    std::getline(fields, chamfer, ',');
    std::getline(fields, missed, ',');
    all[family] = {std::stod(iou), std::stod(chamfer), std::stoi(missed)};
  }
  return all;
}

const std::vector<CaseResult>& results() {
  static const std::vector<CaseResult> all = [] {
    CaseOptions cases;
    cases.views = 1;
    cases.instances = 2;
    cases.seed = 20261122;
    const auto specs = list_family_cases(cases);
    EXPECT_TRUE(specs) << specs.error().what;
    auto run = run_evaluation(*specs, builtin_library());
    EXPECT_TRUE(run) << run.error().what;
    return *run;
  }();
  return all;
}

std::string family_of(const CaseResult& result) { return result.object.substr(0, result.object.find('/')); }

std::map<std::string, Figures> measured_figures() {
  std::map<std::string, std::vector<CaseResult>> by_family;
  for (const CaseResult& result : results()) by_family[family_of(result)].push_back(result);
  std::map<std::string, Figures> figures;
  for (const auto& [family, cases] : by_family) {
    const MethodSummary summary = summarise(cases, 0);
    figures[family] = {summary.iou_filled_median.value_or(0), summary.chamfer_mm_median.value_or(999), summary.missed};
  }
  return figures;
}

TEST(AccuracyGuard, NoFamilyGetsWorse) {
  const auto measured = measured_figures(), committed = committed_figures();
  double sum = 0, committed_sum = 0;
  std::cout << "family,iou_filled,chamfer_mm,missed\n";
  for (const auto& [family, now] : measured) {
    std::cout << fmt::format("{},{:.3f},{:.2f},{}\n", family, now.iou_filled, now.chamfer_mm, now.missed);
    const auto before = committed.find(family);
    if (before == committed.end()) {
      ADD_FAILURE() << family << " has no committed figures";
      continue;
    }
    EXPECT_GE(now.iou_filled, before->second.iou_filled - kIouSlack) << family;
    EXPECT_LE(now.missed, before->second.missed) << family;
    sum += now.iou_filled;
    committed_sum += before->second.iou_filled;
  }
  EXPECT_GE(sum / static_cast<double>(measured.size()), committed_sum / static_cast<double>(committed.size()) - kMeanIouSlack);
}

TEST(AccuracyGuard, EveryMeshIsClosedAndFreeOfSelfIntersections) {
  const MethodSummary summary = summarise(results(), 0);
  EXPECT_EQ(summary.closed_rate, 1.0);
  EXPECT_EQ(summary.self_intersection_rate, 0.0);
}

TEST(AccuracyGuard, WhatIsSeenIsMetToAMillimetre) { EXPECT_LT(summarise(results(), 0).observed_median_mm.value_or(999), 1.0); }

}  // namespace
}  // namespace gfp
