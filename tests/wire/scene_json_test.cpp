#include "wire/scene_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/hand_made_scene.hpp"

namespace gfp {
namespace {

std::vector<std::string> keys(const nlohmann::ordered_json& json) {
  std::vector<std::string> names;
  for (const auto& [key, value] : json.items()) names.push_back(key);
  return names;
}

// The keys are the contract of the command line: a program that reads them must find every one.
TEST(SceneJson, HasEveryKeyOfTheContract) {
  const auto json = scene_json(test::hand_made_scene(), {"table.pcd", "gfp_robust", {{1, "table_0_1.ply"}}});
  for (const char* key : {"input", "frame", "stamp_ns", "sensor", "profile", "method", "support", "ms", "rejected", "objects"})
    EXPECT_TRUE(json.contains(key)) << key;
  const auto& object = json["objects"][0];
  for (const char* key : {"id", "class", "class_probabilities", "method", "T_camera_object", "scale", "extents_m", "pose_covariance",
                          "yaw_interval_rad", "pixels", "bbox_px", "vertices", "triangles", "closed", "self_intersections", "volume_material_m3",
                          "volume_filled_m3", "fit_similarity", "rms_mm", "observed_fraction", "sigma_median_mm", "evidence", "mesh",
                          "no_grasp_reason", "grasps", "ms"})
    EXPECT_TRUE(object.contains(key)) << key;
  const auto& grasp = object["grasps"][0];
  for (const char* key : {"T_camera_tcp", "T_camera_parent", "gripper", "width_m", "approach", "epsilon", "volume_quality", "force_closure",
                          "p_force_closure", "epsilon_lcb", "contacts", "collision_margin_m", "visibility", "abstain"})
    EXPECT_TRUE(grasp.contains(key)) << key;
  EXPECT_EQ(keys(grasp["contacts"][0]), (std::vector<std::string>{"point", "normal", "observed"}));
}

TEST(SceneJson, ValuesAreTheScenes) {
  const Scene scene = test::hand_made_scene();
  const auto json = scene_json(scene, {"table.pcd", "gfp_robust", {}});
  EXPECT_EQ(json["frame"], scene.sequence);
  EXPECT_EQ(json["rejected"].dump(), R"([{"pixels":120,"reason":"too_small"}])");
  const auto& object = json["objects"][0];
  EXPECT_EQ(object["T_camera_object"][0][3], scene.objects[0].model.T_camera_object.translation().x());  // row-major
  EXPECT_EQ(object["triangles"], 12);
  EXPECT_EQ(object["observed_fraction"], 7.0 / 8.0);
  EXPECT_EQ(object["rms_mm"], 2.0);
  EXPECT_TRUE(object["no_grasp_reason"].is_null());
  EXPECT_TRUE(object.at("mesh").is_null());
  EXPECT_EQ(json["objects"][1]["no_grasp_reason"], "too_wide");
}

TEST(SceneJson, NoSupportNoObjectsAndNotFiniteAreNullsAndEmptyLists) {
  Scene scene = test::hand_made_scene(1);
  scene.support.reset();
  scene.objects[0].model.evidence.cost = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(scene_json(scene)["support"].is_null());
  EXPECT_NE(scene_json(scene).dump().find("\"cost\":null"), std::string::npos);
  EXPECT_EQ(scene_json(Scene{})["objects"].dump(), "[]");
}

}  // namespace
}  // namespace gfp
