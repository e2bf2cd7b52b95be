// Two sensors with extrinsics over one table: one memory in the world, so that an object is the same one in both.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "app/builtin_library.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "support/true_shapes.hpp"
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

/// Mean filled IoU of what a scene holds with the true objects, nearest with nearest; 0 for one that is missing.
double mean_iou(const Scene& scene, const SyntheticSource& source, const test::TrueShapes& shapes) {
  const FrameTruth truth = source.truth(0);
  double sum = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Transform T_camera_object = scene.T_world_sensor.inverse() * truth.T_world_camera * truth.T_camera_object[i];
    double best = 0;
    for (const SceneObject& object : scene.objects) best = std::max(best, test::filled_iou(shapes[i], T_camera_object, object.model));
    sum += best;
  }
  return sum / static_cast<double>(shapes.size());
}

// What one sees and the other does not goes into one shape, which both publish: better than either alone, and once both have looked twice it
// stands as it is.
TEST(TwoSensors, FitOneShapeToWhatBothSee) {
  SyntheticSource front(standing_at("front", -1.6)), back(standing_at("back", 1.54));
  const test::TrueShapes shapes = test::true_shapes(front.scene());
  const std::vector<Scene> together = scenes_in_turn({&front, &back}, 4);
  double alone = 0;
  for (const char* name : {"front", "back"}) {
    SyntheticSource source(standing_at(name, name == std::string("front") ? -1.6 : 1.54));
    alone += 0.5 * mean_iou(scenes_in_turn({&source}, 1).back(), source, shapes);
  }
  const Scene &last_front = together[6], &last_back = together[7];
  const double fused_front = mean_iou(last_front, front, shapes), fused_back = mean_iou(last_back, back, shapes);
  std::printf("mean filled IoU: one sensor %.3f, both %.3f and %.3f\n", alone, fused_front, fused_back);
  EXPECT_GT(fused_front, alone + 0.02);
  EXPECT_GT(fused_back, alone + 0.02);
  for (const Scene* scene : {&last_front, &last_back})
    for (const SceneObject& object : scene->objects) EXPECT_EQ(object.status, ObjectStatus::kUnchanged) << scene->sensor << " object " << object.id;
}

/// Mean IoU over the second half of a way around the table, 9 degrees a frame.
double mean_iou_around(int field_views) {
  SyntheticOptions options = standing_at("arm", -1.6);
  options.seed = 11;
  options.table.objects = 5;
  options.motion = "orbit";
  options.orbit_swing_rad = std::numbers::pi;
  options.orbit_period_s = 8;
  options.rate_hz = 5;
  SyntheticSource source(options);
  const test::TrueShapes shapes = test::true_shapes(source.scene());
  PipelineOptions pipeline;
  pipeline.memory.field_views = field_views;
  SceneMemory memory;
  double sum = 0;
  for (int frame = 0; frame < 40; ++frame) {
    PipelineResult result = process_frame(*source.grab(10s), memory, builtin_library(), pipeline);
    memory = std::move(result.memory);
    if (frame >= 20) sum += mean_iou(result.scene, source, shapes) / 20;
  }
  return sum;
}

TEST(MovingSensor, KnowsWhatItSawFromElsewhere) {
  const double without = mean_iou_around(0), with = mean_iou_around(2);
  std::printf("mean filled IoU on the second half of the way: %.3f, with the field %.3f\n", without, with);
  EXPECT_GT(with, without + 0.02);
}

}  // namespace
}  // namespace gfp
