#include "gfp/scene/remember.hpp"

#include <gtest/gtest.h>

#include "gfp/memory/associate.hpp"
#include "support/block_scene.hpp"
#include "support/box_model.hpp"

namespace gfp {
namespace {

const std::vector<test::Block> kTwo{{{20, 30, 40, 50}}, {{100, 30, 120, 50}}};

struct Seen {
  test::BlockScene blocks;
  std::vector<ObjectView> views;
  Scene scene;
};

/// A frame whose objects were all fitted, UNCHANGED where their views say so.
Seen see(const std::vector<test::Block>& blocks, const SceneMemory& memory, std::uint64_t noise_seed = 0) {
  Seen seen{test::block_scene(blocks, noise_seed), {}, {}};
  seen.views = associate(seen.blocks.segments, seen.blocks.cloud, seen.blocks.normals, seen.blocks.frame, memory);
  seen.scene.sensor = seen.blocks.frame.sensor;
  seen.scene.support = seen.blocks.segments.planes.front();
  for (const ObjectView& view : seen.views) {
    ObjectEstimate estimate;
    estimate.model = test::box_model("gfp_robust", "box", {0.1, 0.1, 0.1}, 0.5);
    seen.scene.objects.push_back(describe(estimate, view, view.unchanged ? ObjectStatus::kUnchanged : ObjectStatus::kAdded));
  }
  return seen;
}

TEST(Remember, KeepsPlaceFitAndPlane) {
  const Seen seen = see(kTwo, {});
  const SceneMemory memory = remember(seen.scene, {}, seen.views, {});
  ASSERT_EQ(memory.tracks.size(), 2U);
  EXPECT_EQ(memory.frames, 1U);
  EXPECT_EQ(memory.next_id, 3U);
  EXPECT_TRUE(memory.of(seen.scene.sensor).last_support.has_value());
  const Track& track = memory.tracks[0];
  EXPECT_EQ(track.last().pixels, seen.blocks.segments.segments[0].pixels);
  EXPECT_EQ(track.last().bbox, (PixelRect{20, 30, 40, 50}));
  EXPECT_NEAR(track.centre_world.z(), 0.8, 1e-6);
  EXPECT_EQ(track.fit.method, "gfp_robust");
  EXPECT_DOUBLE_EQ(track.fit.cost, 0.5);
  EXPECT_EQ(track.fit.fits, 1);
}

TEST(Remember, AnUnchangedObjectKeepsTheViewItWasFittedTo) {
  const Seen first = see(kTwo, {}, 1);
  SceneMemory memory = remember(first.scene, {}, first.views, {});
  const auto fitted = memory.tracks[0].last().fitted_view;
  for (std::uint64_t seed = 2; seed <= 5; ++seed) {
    const Seen again = see(kTwo, memory, seed);
    ASSERT_TRUE(again.views[0].unchanged) << "seed " << seed;
    memory = remember(again.scene, {}, again.views, memory);
  }
  EXPECT_EQ(memory.tracks[0].last().fitted_view, fitted);
  EXPECT_EQ(memory.tracks[0].fit.unchanged_frames, 4);
  EXPECT_EQ(memory.tracks[0].fit.fits, 1);
}

// 0.3 mm a frame is far below the noise, but after some frames the fit no longer holds.
TEST(Remember, ASlowDriftIsNoticed) {
  const Seen first = see(kTwo, {}, 1);
  SceneMemory memory = remember(first.scene, {}, first.views, {});
  int frame = 1;
  for (; frame <= 10; ++frame) {
    auto moved = kTwo;
    moved[0].depth_m += 0.0003 * frame;
    const Seen seen = see(moved, memory, 1 + static_cast<std::uint64_t>(frame));
    if (!seen.views[0].unchanged) break;
    memory = remember(seen.scene, {}, seen.views, memory);
  }
  EXPECT_GT(frame, 1);
  EXPECT_LE(frame, 5);  // 0.5 sigma of 1.5 mm
}

TEST(Remember, WhatIsGoneIsLostOnceAndKeepsItsIdForAWhile) {
  const Seen both = see(kTwo, {});
  SceneMemory memory = remember(both.scene, {}, both.views, {});
  AssociateOptions options;
  options.max_missed_frames = 3;
  for (int frame = 1; frame <= 3; ++frame) {
    const Seen one = see({kTwo[0]}, memory);
    EXPECT_EQ(lost_ids(memory, one.views, "blocks"), frame == 1 ? std::vector<std::uint64_t>{2} : std::vector<std::uint64_t>{});
    memory = remember(one.scene, {}, one.views, memory, options);
    EXPECT_EQ(memory.tracks.size(), 2U);
  }
  EXPECT_EQ(see(kTwo, memory).views[1].id, 2U) << "back in time";
  const Seen one = see({kTwo[0]}, memory);
  memory = remember(one.scene, {}, one.views, memory, options);
  EXPECT_EQ(memory.tracks.size(), 1U) << "forgotten";
  EXPECT_EQ(see(kTwo, memory).views[1].id, 3U);
}

TEST(Remember, AnotherSensorsSilenceSaysNothing) {
  const Seen both = see(kTwo, {});
  const SceneMemory memory = remember(both.scene, {}, both.views, {});
  Scene elsewhere;
  elsewhere.sensor = "other";
  EXPECT_TRUE(lost_ids(memory, {}, "other").empty());
  EXPECT_EQ(remember(elsewhere, {}, {}, memory).tracks[0].last().missed_frames, 0);
}

// The left sensor fitted last, then loses sight for good: the right one still knows where that fit was.
TEST(Remember, AFitOutlivesTheSensorThatMadeIt) {
  const Seen both = see(kTwo, {});
  Scene right = both.scene, left = both.scene;
  right.sensor = "right";
  left.sensor = "left";
  left.T_world_sensor.translation() = Eigen::Vector3d(0.01, 0, 0);
  SceneMemory memory = remember(right, {}, both.views, {});
  memory = remember(left, {}, both.views, memory);
  Scene blind;
  blind.sensor = "left";
  for (int frame = 0; frame < 3; ++frame) memory = remember(blind, {}, {}, memory, {.max_missed_frames = 2});
  ASSERT_EQ(memory.tracks.size(), 2U);
  EXPECT_EQ(memory.tracks[0].last().sensor, "right");
  test::BlockScene now = test::block_scene(kTwo, 0);
  now.frame.sensor = "right";
  const auto views = associate(now.segments, now.cloud, now.normals, now.frame, memory);
  ASSERT_TRUE(views[0].warm_start.has_value());
  EXPECT_TRUE(views[0].warm_start->T_camera_object.isApprox(left.T_world_sensor * left.objects[0].model.T_camera_object, 1e-12));
}

TEST(Remember, WhatHadNoFitIsSeenButNotWarm) {
  Seen seen = see(kTwo, {});
  seen.scene.objects.erase(seen.scene.objects.begin());
  const SceneMemory memory = remember(seen.scene, {}, seen.views, {});
  ASSERT_EQ(memory.tracks.size(), 2U);
  EXPECT_FALSE(memory.tracks[0].last().object);
  const Seen again = see(kTwo, memory);
  EXPECT_EQ(again.views[0].id, 1U);
  EXPECT_FALSE(again.views[0].warm_start.has_value());
  EXPECT_FALSE(again.views[0].unchanged);
  EXPECT_TRUE(again.views[1].warm_start.has_value());
}

}  // namespace
}  // namespace gfp
