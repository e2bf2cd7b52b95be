// Two sensors with extrinsics over one table: one memory in the world, so that an object is the same one in both.
#include <gtest/gtest.h>

#include <vector>

#include "app/builtin_library.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "synthetic/synthetic_source.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

SyntheticOptions standing_at(const char* name, double azimuth_rad) {
  SyntheticOptions options;
  options.sensor = name;
  options.seed = 4;
  options.table.objects = 3;
  options.rate_hz = 0;
  options.frame_time = true;
  options.azimuth_rad = azimuth_rad;
  return options;
}

Eigen::Vector3d centre_world(const SceneObject& object, const Scene& scene) { return scene.T_world_sensor * bounds(object.model.mesh_camera().vertices).centre(); }

/// The scenes of both in turn, `rounds` of each.
std::vector<Scene> scenes_in_turn(std::vector<SyntheticSource*> sources, int rounds) {
  std::vector<Scene> scenes;
  SceneMemory memory;
  for (int round = 0; round < rounds; ++round)
    for (SyntheticSource* source : sources) {
      const auto frame = source->grab(10s);
      PipelineResult result = process_frame(*frame, memory, builtin_library());
      memory = std::move(result.memory);
      scenes.push_back(std::move(result.scene));
    }
  return scenes;
}

// What the left sensor saw is known when the right one first looks: the same id, class and place, carried on and not begun anew.
TEST(TwoSensors, SeeTheSameObjects) {
  SyntheticSource left(standing_at("left", -2.2)), right(standing_at("right", -0.9));
  const std::vector<Scene> scenes = scenes_in_turn({&left, &right}, 3);
  const Scene& first = scenes.front();
  ASSERT_EQ(first.objects.size(), 3U);
  for (const Scene& scene : scenes) {
    EXPECT_EQ(scene.sensor, scene.T_world_sensor.isApprox(first.T_world_sensor) ? "left" : "right");
    EXPECT_TRUE(scene.lost.empty()) << "the other sensor's silence says nothing";
    ASSERT_EQ(scene.objects.size(), first.objects.size());
    for (std::size_t i = 0; i < first.objects.size(); ++i) {
      EXPECT_EQ(scene.objects[i].id, first.objects[i].id);
      EXPECT_EQ(scene.objects[i].model.class_name, first.objects[i].model.class_name);
      EXPECT_LT((centre_world(scene.objects[i], scene) - centre_world(first.objects[i], first)).norm(), 0.015) << scene.sensor << " object " << i;
      EXPECT_EQ(scene.objects[i].status == ObjectStatus::kAdded, &scene == &first) << scene.sensor << " object " << i;
    }
  }
}

// One goes blind: the other goes on with the same objects.
TEST(TwoSensors, OneGoesOnAlone) {
  SyntheticSource left(standing_at("left", -2.2)), right(standing_at("right", -0.9));
  SceneMemory memory;
  std::vector<std::uint64_t> ids;
  for (SyntheticSource* source : {&left, &right, &right, &right, &right}) {
    PipelineResult result = process_frame(*source->grab(10s), memory, builtin_library());
    memory = std::move(result.memory);
    std::vector<std::uint64_t> now;
    for (const SceneObject& object : result.scene.objects) now.push_back(object.id);
    if (ids.empty()) ids = now;
    EXPECT_EQ(now, ids);
  }
}

}  // namespace
}  // namespace gfp
