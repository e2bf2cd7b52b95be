#include "gfp/evaluation/summary.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gfp {
namespace {

CaseResult result_of(const std::string& class_name, double iou, double chamfer_m) {
  CaseResult result;
  result.source = "meshes";
  result.object = class_name + "/\"one\"";
  result.view = "e20 y0";
  result.class_name = class_name;
  MethodResult method;
  method.method = "gfp_robust";
  method.metrics.iou_filled = iou;
  method.metrics.chamfer_m = chamfer_m;
  method.metrics.closed = true;
  method.metrics.sigma_observed = {6, 10};
  method.class_correct = true;
  method.class_probability = 0.9;
  method.cpu_ms = 10;
  result.methods.push_back(method);
  return result;
}

CaseResult missed(const std::string& class_name) {
  CaseResult result = result_of(class_name, 0, 0);
  result.missed = true;
  result.methods.front() = {};
  result.methods.front().method = "gfp_robust";
  result.methods.front().class_correct = false;
  return result;
}

// Two fits and a miss: the miss is the worst IoU and an infinite distance, and no mesh at all.
TEST(Summarise, AMissIsTheWorstFitThereIs) {
  const std::vector<CaseResult> results{result_of("mug", 0.9, 0.002), missed("mug"), result_of("mug", 0.8, 0.004)};
  const MethodSummary s = summarise(results, 0);
  EXPECT_EQ(s.cases, 3);
  EXPECT_EQ(s.missed, 1);
  EXPECT_EQ(s.iou_filled_median, 0.8);
  EXPECT_EQ(s.chamfer_mm_median, 4.0);
  EXPECT_EQ(s.closed_rate, 1.0);
  EXPECT_EQ(s.ms_median, 10.0);
  EXPECT_NEAR(s.class_accuracy.value(), 2.0 / 3, 1e-12);
  EXPECT_NEAR(s.class_probability_mean.value(), 0.6, 1e-12) << "nothing is said of what is missed";
  EXPECT_EQ(s.sigma_coverage_observed, 0.6);
  EXPECT_FALSE(s.yaw_error_deg_median.has_value());
}

TEST(Summarise, AMedianThatFallsOnAMissDoesNotExist) {
  const MethodSummary s = summarise({missed("mug"), missed("mug"), result_of("mug", 1, 0.001)}, 0);
  EXPECT_FALSE(s.chamfer_mm_median.has_value());
  EXPECT_EQ(s.iou_filled_median, 0.0);
}

TEST(Summarise, NoCasesHaveNoNumbers) {
  const MethodSummary s = summarise({result_of("mug", 1, 0)}, 0, "cup");
  EXPECT_EQ(s.cases, 0);
  EXPECT_FALSE(s.iou_filled_median.has_value());
}

TEST(EvaluationRecord, JsonHasTheKeysOfTheContract) {
  const EvaluationRecord record{"a machine", "abc", 7, {"gfp_robust"}, "", {result_of("mug", 0.9, 0.002), missed("bowl")}};
  const auto json = nlohmann::json::parse(to_json(record));
  for (const char* key : {"machine", "commit", "seed", "cases", "summary"}) EXPECT_TRUE(json.contains(key)) << key;
  const auto& summary = json["summary"]["gfp_robust"];
  for (const char* key : {"iou_filled_median", "iou_material_median", "volume_error_median", "chamfer_mm_median", "hidden_chamfer_mm_median", "fscore_5mm",
                          "closed_rate", "self_intersection_rate", "fit_similarity_median", "sigma_coverage_observed", "sigma_coverage_inferred",
                          "class_accuracy", "grasp_success_1", "grasp_success_5", "ms_median", "ms_p99", "per_class"})
    EXPECT_TRUE(summary.contains(key)) << key;
  EXPECT_EQ(summary["per_class"]["mug"]["iou_filled_median"], 0.9);
  EXPECT_EQ(summary["per_class"]["bowl"]["missed"], 1);
  EXPECT_TRUE(json["cases"][1]["methods"]["gfp_robust"]["chamfer_mm"].is_null()) << "infinity has no place in JSON";
}

TEST(EvaluationRecord, CsvHasOneLineACaseAndMethodWithAsManyFieldsAsItsHeader) {
  const EvaluationRecord record{"a machine", "abc", 7, {"gfp_robust"}, "", {result_of("mug", 0.9, 0.002), missed("bowl")}};
  const std::string csv = to_csv(record);
  std::vector<long> commas{0};
  for (const char c : csv) {
    if (c == ',') ++commas.back();
    if (c == '\n') commas.push_back(0);
  }
  ASSERT_EQ(commas.size(), 4U);
  EXPECT_EQ(commas[1], commas[0]);
  EXPECT_EQ(commas[2], commas[0]);
}

}  // namespace
}  // namespace gfp
