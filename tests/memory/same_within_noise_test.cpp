#include <gtest/gtest.h>

#include "gfp/memory/associate.hpp"
#include "support/block_scene.hpp"

namespace gfp {
namespace {

ObjectView view_of(const test::Block& block, std::uint64_t noise_seed) {
  const auto scene = test::block_scene({block}, noise_seed);
  return associate(scene.segments, scene.cloud, scene.normals, scene.frame, {}).front();
}

constexpr PixelRect kFace{40, 30, 80, 70};

TEST(SameWithinNoise, NoiseAloneIsNoChange) {
  const ObjectView before = view_of({kFace}, 1);
  for (std::uint64_t seed = 2; seed <= 20; ++seed) EXPECT_TRUE(same_within_noise(view_of({kFace}, seed), before)) << "seed " << seed;
}

// 1600 readings of 1.5 mm noise tell 2 mm from nothing; one pixel at 0.8 m is 6 mm on this small camera.
TEST(SameWithinNoise, SeesSmallMovesInEveryDirection) {
  const ObjectView before = view_of({kFace}, 1);
  EXPECT_FALSE(same_within_noise(view_of({kFace, 0.802}, 2), before));
  EXPECT_FALSE(same_within_noise(view_of({{41, 30, 81, 70}}, 2), before));
  EXPECT_FALSE(same_within_noise(view_of({{40, 31, 80, 71}}, 2), before));
}

TEST(SameWithinNoise, SeesAnotherShapeOrCamera) {
  const ObjectView before = view_of({kFace}, 1);
  EXPECT_FALSE(same_within_noise(view_of({{40, 30, 80, 58}}, 2), before));
  ObjectView other_camera = view_of({kFace}, 2);
  other_camera.camera.fx += 1;
  EXPECT_FALSE(same_within_noise(other_camera, before));
  ObjectView hidden = view_of({kFace}, 2);
  hidden.occluded = true;
  EXPECT_FALSE(same_within_noise(hidden, before));
}

TEST(SameWithinNoise, FarApartHasNothingInCommon) {
  EXPECT_FALSE(same_within_noise(view_of({{2, 2, 20, 20}}, 0), view_of({{100, 80, 120, 100}}, 0)));
}

}  // namespace
}  // namespace gfp
