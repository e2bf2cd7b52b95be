#include "gfp/primitive/upsampled.hpp"

#include <gtest/gtest.h>

#include "gfp/core/self_intersections.hpp"
#include "gfp/primitive/families.hpp"

namespace gfp {
namespace {

// The mug has all there is: genus 1, an inner wall, a lid on its rim, modes.
TEST(Upsampled, IsTheSameShapeWithFourTimesTheTriangles) {
  const Primitive mug = build_family_primitive("mug");
  const Primitive finer = upsampled(mug, 1);
  EXPECT_EQ(finer.topology->triangles.size(), 4 * mug.topology->triangles.size());
  EXPECT_EQ(finer.modes.size(), mug.modes.size());
  for (const std::vector<double>& modes : {std::vector<double>{}, {1.5, -1.0}}) {
    const TriangleMesh before{shape(mug, mug.typical_size_m(), modes), mug.topology->triangles}, after{shape(finer, mug.typical_size_m(), modes), finer.topology->triangles};
    EXPECT_TRUE(examine_topology(after).closed);
    EXPECT_EQ(examine_topology(after).euler_characteristic, 0);
    EXPECT_EQ(count_self_intersections(after, 1), 0);
    EXPECT_NEAR(signed_volume(after), signed_volume(before), 1e-12);
    const TriangleMesh lid_before{before.vertices, mug.topology->filled_triangles}, lid_after{after.vertices, finer.topology->filled_triangles};
    EXPECT_TRUE(examine_topology(lid_after).closed);
    EXPECT_NEAR(signed_volume(lid_after), signed_volume(lid_before), 1e-12);
  }
  for (std::size_t i = 0; i < mug.size(); ++i) {
    ASSERT_EQ(finer.mean[i], mug.mean[i]);
    ASSERT_EQ(finer.topology->parts[i], mug.topology->parts[i]);
  }
  EXPECT_EQ(finer.topology->types.size(), finer.size());
  EXPECT_EQ(finer.topology->parts.size(), finer.size());
  EXPECT_NEAR(finer.rest_edge_length, 0.5 * mug.rest_edge_length, 0.1 * mug.rest_edge_length);
  EXPECT_FALSE(finer.contact_pairs.empty());
  EXPECT_NE(finer.content_hash, mug.content_hash);
  EXPECT_NE(finer.topology->hash, mug.topology->hash);
}

TEST(Upsampled, KeepsAPersonsTypesAndBoundsItsLevels) {
  Primitive ball = build_family_primitive("ball");
  ball.manual_types.assign(ball.size(), std::nullopt);
  ball.manual_types[7] = PointType::kControl;
  ball.manual_types[8] = PointType::kRegular;
  const Primitive finer = upsampled(ball, 2);
  EXPECT_EQ(finer.topology->types[7], PointType::kControl);
  EXPECT_EQ(finer.topology->types[8], PointType::kRegular);
  EXPECT_EQ(finer.manual_types.size(), finer.size());
  EXPECT_EQ(upsampled(ball, 9).size(), finer.size());
  EXPECT_EQ(upsampled(ball, 0).content_hash, ball.content_hash);
}

}  // namespace
}  // namespace gfp
