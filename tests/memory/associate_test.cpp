#include "gfp/memory/associate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/block_scene.hpp"

namespace gfp {
namespace {

using test::Block;
using test::block_scene;
using test::BlockScene;

std::vector<ObjectView> views_of(const BlockScene& scene, const SceneMemory& memory = {}) {
  return associate(scene.segments, scene.cloud, scene.normals, scene.frame, memory);
}

/// What `remember` keeps of a frame, without any fit.
SceneMemory memory_of(const BlockScene& scene, const std::vector<ObjectView>& views) {
  SceneMemory memory;
  for (const ObjectView& view : views) {
    const Segment& segment = scene.segments.segments[static_cast<std::size_t>(view.segment)];
    Track track;
    track.id = view.id;
    track.sensors.resize(1);
    track.sensors[0].sensor = scene.frame.sensor;
    track.sensors[0].T_world_sensor = scene.frame.T_world_sensor;
    for (const std::int32_t pixel : segment.pixels) track.centre_world += scene.cloud.point(static_cast<std::size_t>(pixel)).cast<double>();
    track.centre_world = scene.frame.T_world_sensor * Eigen::Vector3d(track.centre_world / static_cast<double>(segment.pixels.size()));
    track.height_m = view.height_m;
    track.sensors[0].pixels = segment.pixels;
    memory.tracks.push_back(track);
    memory.next_id = std::max(memory.next_id, view.id + 1);
  }
  return memory;
}

TEST(Associate, CutsTheTileWithItsMargin) {
  const auto scene = block_scene({{{40, 30, 80, 70}, 0.8}});
  const auto views = views_of(scene);
  ASSERT_EQ(views.size(), 1U);
  EXPECT_EQ(views[0].tile, (PixelRect{28, 18, 92, 82}));  // 12 px is more than 25 % of 40
  EXPECT_EQ(views[0].object_pixels, 1600);
  EXPECT_EQ(views[0].depth_m.width, 64);
  EXPECT_FLOAT_EQ(views[0].depth_m.at(12, 12), 0.8F);
  EXPECT_EQ(views[0].normals.at(12, 12), -Eigen::Vector3f::UnitZ());
  EXPECT_EQ(views[0].normals.at(0, 0), Eigen::Vector3f::Zero()) << "normals are the object's only";
}

TEST(Associate, ClipsTheTileToTheImage) {
  const auto views = views_of(block_scene({{{0, 100, 100, 120}, 0.8}}));
  EXPECT_EQ(views[0].tile, (PixelRect{0, 75, 125, 120}));  // 25 % of 100 px
}

TEST(Associate, SaysWhatEveryPixelMeans) {
  auto scene = block_scene({{{40, 30, 60, 50}, 0.8}, {{66, 30, 80, 50}, 0.7}});
  scene.segments.labels.at(35, 40) = Segments::kUnassigned;  // at the plane's depth, farther than the block
  scene.segments.labels.at(36, 40) = Segments::kUnassigned;
  test::set_point(scene.cloud, 36, 40, 0.6);                 // before the block
  scene.cloud.z[scene.segments.labels.index(37, 40)] = std::numeric_limits<float>::quiet_NaN();
  scene.segments.labels.at(38, 40) = Segments::kPlaneLabel - 1;  // another plane, behind
  const ObjectView view = views_of(scene)[0];
  const auto evidence = [&](int u, int v) { return view.evidence.at(u - view.tile.u0, v - view.tile.v0); };
  EXPECT_EQ(evidence(45, 40), Evidence::kObject);
  EXPECT_EQ(evidence(70, 40), Evidence::kOther);
  EXPECT_EQ(evidence(34, 40), Evidence::kSupport);
  EXPECT_EQ(evidence(35, 40), Evidence::kBackground);
  EXPECT_EQ(evidence(36, 40), Evidence::kOther);
  EXPECT_EQ(evidence(37, 40), Evidence::kUnknown);
  EXPECT_EQ(evidence(38, 40), Evidence::kBackground);
  EXPECT_EQ(view.depth_m.at(37 - view.tile.u0, 40 - view.tile.v0), 0.0F);
}

TEST(Associate, NoSegmentIsNoView) { EXPECT_TRUE(views_of(block_scene({})).empty()); }

TEST(Associate, GivesTheOutlinesOfTheOthersOnly) {
  const auto views = views_of(block_scene({{{20, 30, 40, 50}}, {{60, 30, 80, 50}}, {{100, 30, 120, 50}}}));
  ASSERT_EQ(views[1].neighbour_footprints.size(), 2U);
  for (const auto& outline : views[1].neighbour_footprints)
    for (const auto& corner : outline) EXPECT_GT(std::abs(corner.x()), 0.1) << "its own outline is in the middle of the image";
}

TEST(Associate, GuessesASupportBelowWhatHasNone) {
  auto scene = block_scene({{{40, 30, 80, 70}, 0.8, -1}});
  scene.segments.planes.clear();
  const ObjectView view = views_of(scene)[0];
  EXPECT_FALSE(view.has_support);
  EXPECT_TRUE(view.T_camera_support.linear().col(2).isApprox(-Eigen::Vector3d::UnitY())) << "up in the image";
  EXPECT_NEAR(view.T_camera_support.linear().determinant(), 1.0, 1e-12);
  const double lowest_y = scene.frame.camera.ray(60, 69).y() * 0.8;
  EXPECT_NEAR(view.T_camera_support.translation().y(), lowest_y, 1e-6);
  EXPECT_NEAR(view.height_m, 39 * 0.8 / scene.frame.camera.fy, 1e-4);

  scene.frame.up_camera = Eigen::Vector3d(0, -1, -1).normalized();  // the accelerometer knows better
  EXPECT_TRUE(views_of(scene)[0].T_camera_support.linear().col(2).isApprox(*scene.frame.up_camera));
}

TEST(Associate, NumbersNewObjectsFromTheMemory) {
  SceneMemory memory;
  memory.next_id = 41;
  const auto views = views_of(block_scene({{{20, 30, 40, 50}}, {{60, 30, 80, 50}}}), memory);
  EXPECT_EQ(views[0].id, 41U);
  EXPECT_EQ(views[1].id, 42U);
}

// Ten frames of noise, the segments in another order each time: everyone keeps the id.
TEST(Associate, KeepsIdsInAStaticScene) {
  const std::vector<Block> blocks{{{10, 30, 30, 50}}, {{40, 30, 60, 50}, 0.7}, {{70, 30, 90, 50}, 0.75}};
  auto scene = block_scene(blocks, 1);
  auto views = views_of(scene);
  SceneMemory memory = memory_of(scene, views);
  for (std::uint64_t frame = 2; frame <= 10; ++frame) {
    std::vector<Block> turned{blocks[frame % 3], blocks[(frame + 1) % 3], blocks[(frame + 2) % 3]};
    scene = block_scene(turned, frame);
    views = views_of(scene, memory);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(views[i].id, (frame + i) % 3 + 1) << "frame " << frame;
    memory = memory_of(scene, views);
    std::sort(memory.tracks.begin(), memory.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
    EXPECT_EQ(memory.next_id, 4U);
  }
}

// Both blocks move right by more than half their pitch: nearest-first would give the left one's new place to the right one's id.
TEST(Associate, FollowsARowThatMovesTogether) {
  const auto before = block_scene({{{20, 30, 30, 50}}, {{36, 30, 46, 50}}});
  const auto views_before = views_of(before);
  const auto after = block_scene({{{29, 30, 39, 50}}, {{45, 30, 55, 50}}});
  const auto views_after = views_of(after, memory_of(before, views_before));
  EXPECT_EQ(views_after[0].id, views_before[0].id);
  EXPECT_EQ(views_after[1].id, views_before[1].id);
}

TEST(Associate, AnObjectThatWasHiddenGetsItsIdBack) {
  const auto scene = block_scene({{{20, 30, 40, 50}}, {{100, 30, 120, 50}}});
  SceneMemory memory = memory_of(scene, views_of(scene));
  memory.tracks[1].sensors[0].missed_frames = 20;
  EXPECT_EQ(views_of(scene, memory)[1].id, 2U);
}

TEST(Associate, AFarNewcomerIsNobodyKnown) {
  const auto before = block_scene({{{10, 30, 30, 50}}});
  const auto after = block_scene({{{120, 30, 140, 50}}});
  EXPECT_EQ(views_of(after, memory_of(before, views_of(before)))[0].id, 2U);
}

// The camera turns by 10 degrees: pixels say nothing, the world says it is the same block.
TEST(Associate, KnowsObjectsByTheirPlaceWhenTheCameraMoves) {
  const auto before = block_scene({{{70, 50, 90, 70}}});
  const SceneMemory memory = memory_of(before, views_of(before));
  auto after = block_scene({{{47, 50, 67, 70}}});
  const double angle = std::atan((80.0 - 57.0) / after.frame.camera.fx);  // puts the block's ray where it was
  after.frame.T_world_sensor.linear() = rotation_from_vector({0, angle, 0});
  EXPECT_EQ(views_of(after, memory)[0].id, 1U);
}

}  // namespace
}  // namespace gfp
