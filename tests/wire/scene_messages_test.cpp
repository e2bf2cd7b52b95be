#include "wire/scene_messages.hpp"

#include <gtest/gtest.h>

#include "support/hand_made_scene.hpp"
#include "support/mutate.hpp"
#include "wire/bounded_parse.hpp"
#include "wire/scene_json.hpp"

namespace gfp::wire {
namespace {

TopologyLookup lookup_in(const Scene& scene) {
  return [&scene](std::uint64_t hash) -> std::shared_ptr<const Topology> {
    for (const SceneObject& object : scene.objects)
      if (object.model.topology->hash == hash) return object.model.topology;
    return nullptr;
  };
}

std::string sent(const Scene& scene) {
  v1::Scene message;
  fill(scene, VertexCoding::kFloat32, message);
  return message.SerializeAsString();
}

Result<Scene> received(const std::string& bytes, const TopologyLookup& topologies) {
  v1::Scene message;
  if (auto parsed = parse_bounded(as_bytes(bytes), kMaxSceneBytes, message); !parsed) return tl::unexpected(parsed.error());
  return scene_from(message, topologies);
}

// The JSON line holds every member that a person or program is promised. The vertices are numbers that float32 holds exactly.
TEST(SceneMessages, ASceneComesBackTheSame) {
  const Scene scene = test::hand_made_scene(3);
  const auto back = received(sent(scene), lookup_in(scene));
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_EQ(scene_json(*back).dump(), scene_json(scene).dump());
  EXPECT_EQ(back->stamps.monotonic, scene.stamps.monotonic);
  EXPECT_EQ(back->stamps.realtime, scene.stamps.realtime);
  EXPECT_EQ(back->camera, scene.camera);
  EXPECT_EQ(back->T_world_sensor.matrix(), scene.T_world_sensor.matrix());
  EXPECT_EQ(back->support->polygon, scene.support->polygon);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const FittedModel &a = scene.objects[i].model, &b = back->objects[i].model;
    EXPECT_EQ(b.vertices, a.vertices);
    EXPECT_EQ(b.states, a.states);
    EXPECT_EQ(b.sigma_m, a.sigma_m);
    EXPECT_EQ(b.modes, a.modes);
    EXPECT_EQ(b.stable_pose, a.stable_pose);
    EXPECT_EQ(b.iterations, a.iterations);
    EXPECT_EQ(b.converged, a.converged);
    EXPECT_EQ(b.energies, a.energies);
    EXPECT_EQ(b.topology->triangles, a.topology->triangles);
  }
}

TEST(SceneMessages, AnEmptySceneComesBackEmpty) {
  Scene scene;
  scene.camera = default_kinect_camera();
  const auto back = received(sent(scene), {});
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_TRUE(back->objects.empty());
  EXPECT_FALSE(back->support.has_value());
}

TEST(SceneMessages, WithoutItsTopologyAnObjectHasItsHashAndNoTriangles) {
  const Scene scene = test::hand_made_scene(1);
  const auto back = received(sent(scene), {});
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_EQ(back->objects[0].model.topology->hash, scene.objects[0].model.topology->hash);
  EXPECT_TRUE(back->objects[0].model.topology->triangles.empty());
}

TEST(SceneMessages, ATopologyOfMoreVerticesThanTheObjectIsRefused) {
  const Scene scene = test::hand_made_scene(1);
  auto larger = std::make_shared<Topology>(*scene.objects[0].model.topology);
  larger->triangles.push_back({0, 1, 8});
  const auto back = received(sent(scene), [&](std::uint64_t) { return larger; });
  ASSERT_FALSE(back.has_value());
  EXPECT_EQ(back.error().what, "object 1 has 8 vertices, its topology names vertex 8");
}

TEST(SceneMessages, AnObjectTravelsAloneWithWhatPlacesIt) {
  const Scene scene = test::hand_made_scene(2);
  v1::ObjectUpdate message;
  fill(scene, scene.objects[1], VertexCoding::kFloat32, message);
  EXPECT_EQ(message.header().frame_id(), "front_optical");
  EXPECT_TRUE(message.has_support());
  const auto object = object_from(message.object(), lookup_in(scene));
  ASSERT_TRUE(object.has_value()) << object.error().what;
  EXPECT_EQ(object->id, 2U);
  EXPECT_EQ(object->grasps.no_grasp_reason, "too_wide");
}

TEST(SceneMessages, ALostObjectIsItsId) {
  v1::ObjectUpdate message;
  fill_lost(test::hand_made_scene(), 77, message);
  const auto object = object_from(message.object(), {});
  ASSERT_TRUE(object.has_value()) << object.error().what;
  EXPECT_EQ(object->id, 77U);
  EXPECT_EQ(object->status, ObjectStatus::kLost);
}

TEST(SceneMessages, TooLargeIsRefusedBeforeParsing) {
  v1::Scene message;
  EXPECT_EQ(parse_bounded(as_bytes(std::string(101, '\0')), 100, message).error().code, ErrorCode::kTooLarge);
}

// A hundred objects are an ordinary scene, not a limit.
TEST(SceneMessages, AHundredObjectsPass) {
  const Scene scene = test::hand_made_scene(100);
  const auto back = received(sent(scene), lookup_in(scene));
  ASSERT_TRUE(back.has_value()) << back.error().what;
  EXPECT_EQ(back->objects.size(), 100U);
}

// Damaged bytes end as an error or as a scene whose arrays fit together.
TEST(SceneMessages, DamagedBytesNeverBreakAPromise) {
  const Scene scene = test::hand_made_scene(2);
  const std::string good = sent(scene);
  int survived = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto back = received(test::mutated(good, seed, good.size()), lookup_in(scene));
    if (!back) continue;
    ++survived;
    for (const SceneObject& object : back->objects) {
      if (object.status == ObjectStatus::kLost) continue;
      EXPECT_TRUE(object.model.states.empty() || object.model.states.size() == object.model.vertices.size()) << seed;
      ASSERT_TRUE(object.model.topology != nullptr) << seed;
    }
  }
  EXPECT_GT(survived, 50);  // a changed number is not damage that can be seen: both paths were tried
}

}  // namespace
}  // namespace gfp::wire
