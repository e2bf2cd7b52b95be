// Methods by name in the whole pipeline: beside each other on the same views, and with their own options.
#include <gtest/gtest.h>

#include "app/builtin_library.hpp"
#include "gfp/pipeline/process_frame.hpp"
#include "gfp/pipeline/shadow_scene.hpp"
#include "support/table_frame.hpp"

namespace gfp {
namespace {

TEST(ShadowScene, SeesTheSameObjectsWithAnotherMethod) {
  const Frame frame = test::table_frame({{-0.18, 0}, {0.02, 0.03, {0.08, 0.05, 0.07}, 0.9}, {0.2, -0.05, {0.05, 0.05, 0.14}, 0.1}});
  PipelineOptions options;
  options.shadow = "superquadric";
  const PipelineResult result = process_frame(frame, {}, builtin_library(), options);
  ASSERT_EQ(result.scene.objects.size(), 3U);
  ShadowMemory kept;
  const Scene shadow = shadow_scene(result.scene, result.memory, builtin_library(), options, kept);
  EXPECT_EQ(shadow.profile, "superquadric");
  EXPECT_EQ(shadow.sequence, result.scene.sequence);
  ASSERT_EQ(shadow.objects.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(shadow.objects[k].id, result.scene.objects[k].id);
    EXPECT_EQ(shadow.objects[k].model.method, "superquadric");
    EXPECT_TRUE(shadow.objects[k].closed);
    EXPECT_TRUE(shadow.objects[k].grasps.grasps.empty());
    EXPECT_FALSE(shadow.objects[k].ms.empty());
    const auto middle = [&](const Scene& scene) { return bounds(scene.objects[k].model.vertices_camera()).centre(); };
    EXPECT_LT((middle(shadow) - middle(result.scene)).norm(), 0.02);
  }
  EXPECT_EQ(kept.objects.size(), 3U);

  // The same views are not fitted again; another method starts anew.
  kept.objects.begin()->second.object.pixels = 12345;
  EXPECT_EQ(shadow_scene(result.scene, result.memory, builtin_library(), options, kept).objects[0].pixels, 12345);
  options.shadow = "simple_primitive";
  EXPECT_EQ(shadow_scene(result.scene, result.memory, builtin_library(), options, kept).objects[0].model.method, "simple_primitive");
  EXPECT_TRUE(shadow_scene(result.scene, {}, builtin_library(), options, kept).objects.empty());
}

TEST(Methods, ThePapersOptionsReachItsContour) {
  const Frame frame = test::table_frame({{0.02, 0.03, {0.08, 0.05, 0.07}, 0.9}});
  PipelineOptions options;
  options.method = "sphere_snake";
  const auto iterations = [&] { return process_frame(frame, {}, builtin_library(), options).scene.objects.at(0).model.iterations; };
  EXPECT_GT(iterations(), 3);
  options.paper.contour.max_iterations = 3;
  EXPECT_EQ(iterations(), 3);
  options.method = "gfp_paper";
  options.paper.contour.max_iterations = 0;
  EXPECT_EQ(iterations(), 0);
}

}  // namespace
}  // namespace gfp
