#include "cli/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/canvas.hpp"
#include "cli/font5x7.hpp"
#include "gfp/frame/png.hpp"
#include "gfp/memory/associate.hpp"
#include "gfp/scene/remember.hpp"
#include "support/block_scene.hpp"
#include "support/box_model.hpp"

namespace gfp {
namespace {

int count(const Image<Rgb8>& image, Rgb8 color) { return static_cast<int>(std::count(image.pixels.begin(), image.pixels.end(), color)); }

struct Pictured {
  Frame frame;
  Scene scene;
  SceneMemory memory;
};

/// Three boxes before a wall, as fitted by hand; the wall is the support.
Pictured boxes() {
  test::BlockScene blocks = test::block_scene({{{60, 80, 100, 140}, 0.8}, {{140, 90, 190, 140}, 0.75}, {{220, 60, 260, 150}, 0.85}}, 0, 320, 240);
  Pictured p{blocks.frame, {}, {}};
  p.frame.depth.pixels = Image<std::uint16_t>(320, 240);
  for (std::size_t i = 0; i < blocks.cloud.size(); ++i) p.frame.depth.pixels.pixels[i] = static_cast<std::uint16_t>(1000 * blocks.cloud.z[i] + 0.5F);
  const auto views = associate(blocks.segments, blocks.cloud, blocks.normals, blocks.frame, {});
  p.scene.sensor = p.frame.sensor;
  p.scene.camera = p.frame.camera;
  p.scene.support = blocks.segments.planes.front();
  p.scene.support->polygon = {{-0.25, -0.2}, {0.25, -0.2}, {0.25, 0.2}, {-0.25, 0.2}};
  p.scene.rejected = {{120, "too_small"}};
  for (const ObjectView& view : views) {
    ObjectEstimate estimate;
    estimate.model = test::box_model("gfp_robust", "box", {0.12, 0.16, 0.2});
    estimate.model.T_camera_object = view.T_camera_support;
    estimate.model.T_camera_object.translation() += 1.0 * view.camera.ray((view.tile.u0 + view.tile.u1) / 2.0, (view.tile.v0 + view.tile.v1) / 2.0) - Eigen::Vector3d::UnitZ();
    for (std::size_t i = 0; i < 4; ++i) estimate.model.states[i] = kVertexControl;
    estimate.class_probabilities = {{"box", 0.9}, {"unknown", 0.1}};
    SceneObject object = describe(estimate, view, ObjectStatus::kAdded);
    Grasp grasp;
    grasp.T_camera_tcp.linear() << 0, 1, 0, 0, 0, 1, 1, 0, 0;  // approach along the view, closing along x
    grasp.T_camera_tcp.translation() = estimate.model.T_camera_object * Eigen::Vector3d(0, 0, 0.15);
    grasp.width_m = 0.12;
    grasp.epsilon = 0.123;
    object.grasps.grasps = {grasp};
    p.scene.objects.push_back(object);
  }
  p.memory = remember(p.scene, {}, views, {});
  return p;
}

TEST(Overlay, ShowsEveryObjectSupportAndGrasp) {
  const Pictured p = boxes();
  const Image<Rgb8> picture = draw_overlay(p.frame, p.scene, p.memory, {}, "boxes");
  EXPECT_GT(picture.width, 2000);
  for (const std::uint64_t id : {1U, 2U, 3U}) EXPECT_GT(count(picture, distinct_color(id)), 1000) << "outline and label of object " << id;
  EXPECT_GT(count(picture, {255, 255, 80}), 200) << "best grasps";
  if (const char* file = std::getenv("GFP_OVERLAY_PNG")) {  // for people
    EXPECT_TRUE(write_png(file, picture));
  }
}

TEST(Overlay, IsTheSameEveryTime) {
  const Pictured p = boxes();
  EXPECT_EQ(draw_overlay(p.frame, p.scene, p.memory, {}, "x").pixels, draw_overlay(p.frame, p.scene, p.memory, {}, "x").pixels);
}

// One pixel, nothing seen, nothing found: still a picture of bounded size.
TEST(Overlay, OfAnEmptyOrTinyFrameIsAPicture) {
  for (const int side : {1, 3, 2000}) {
    Frame frame;
    frame.camera = default_kinect_camera(side, side);
    frame.depth.pixels = Image<std::uint16_t>(side, side);
    Scene scene;
    scene.camera = frame.camera;
    const Image<Rgb8> picture = draw_overlay(frame, scene, {}, {}, "empty");
    EXPECT_LT(picture.width, 4000) << side;
    EXPECT_LT(picture.height, 4000) << side;
  }
}

TEST(Canvas, ClipsEverything) {
  Canvas canvas(10, 10, {0, 0, 0});
  canvas.line({-5, -5}, {20, 20}, {255, 0, 0}, 3);
  canvas.line({-1e9, 0}, {1e9, 0}, {255, 0, 0});
  canvas.line({std::nan(""), 0}, {1, 1}, {255, 0, 0});
  canvas.disc({100, 100}, 5, {255, 0, 0});
  canvas.text(-20, 8, "clipped", {255, 0, 0});
  canvas.label(500, 500, "a long label", {255, 0, 0});
  EXPECT_EQ(canvas.image().pixels.size(), 100U);
}

TEST(Canvas, DrawsALineOfItsThickness) {
  Canvas canvas(21, 21, {0, 0, 0});
  canvas.line({2, 10}, {18, 10}, {255, 255, 255}, 3);
  for (int v = 0; v < 21; ++v) EXPECT_EQ(canvas.image().at(10, v).r, v >= 9 && v <= 11 ? 255 : 0) << v;
}

TEST(Font, TellsAllItsLettersApart) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:;-_+/()%#=<>[]|*!?'\"";
  for (std::size_t i = 0; i < letters.size(); ++i)
    for (std::size_t j = i + 1; j < letters.size(); ++j) EXPECT_NE(glyph(letters[i]), glyph(letters[j])) << letters[i] << letters[j];
  EXPECT_EQ(glyph('a'), glyph('A'));
}

}  // namespace
}  // namespace gfp
