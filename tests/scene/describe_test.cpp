#include <gtest/gtest.h>

#include "gfp/memory/associate.hpp"
#include "gfp/scene/remember.hpp"
#include "support/block_scene.hpp"
#include "support/box_model.hpp"

namespace gfp {
namespace {

ObjectView block_view() {
  const auto scene = test::block_scene({{{40, 30, 80, 70}, 0.8}});
  return associate(scene.segments, scene.cloud, scene.normals, scene.frame, {}).front();
}

SceneObject described(FittedModel model) {
  ObjectEstimate estimate;
  estimate.model = std::move(model);
  estimate.class_probabilities = {{"box", 0.9}, {"unknown", 0.1}};
  return describe(std::move(estimate), block_view(), ObjectStatus::kAdded);
}

TEST(Describe, MeasuresAClosedBox) {
  const SceneObject object = described(test::box_model("gfp_robust", "box", {0.1, 0.2, 0.05}));
  EXPECT_NEAR(object.volume_material_m3, 0.001, 1e-15);
  EXPECT_NEAR(object.volume_filled_m3, 0.001, 1e-15);
  EXPECT_TRUE(object.closed);
  EXPECT_EQ(object.self_intersections, 0);
  EXPECT_EQ(object.pixels, 1600);
  EXPECT_EQ(object.bbox, (PixelRect{40, 30, 80, 70}));
  EXPECT_DOUBLE_EQ(object.class_probabilities.at("box"), 0.9);
}

TEST(Describe, SaysThatABoxWithoutALidIsOpen) {
  FittedModel model = test::box_model();
  auto open = std::make_shared<Topology>(*model.topology);
  open->triangles.erase(open->triangles.begin() + 2, open->triangles.begin() + 4);
  model.topology = open;
  EXPECT_FALSE(described(model).closed);
}

TEST(Describe, CountsWhatCrosses) {
  FittedModel model = test::box_model();
  model.vertices[7] = {-0.2, -0.2, -0.1};  // a top corner pulled through the floor
  EXPECT_GT(described(model).self_intersections, 0);
}

}  // namespace
}  // namespace gfp
