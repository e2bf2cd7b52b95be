#include "gfp/modelling/model_contour_paper.hpp"

#include <gtest/gtest.h>

#include "support/simple_primitives.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// A can of 80 x 120 mm on the table, one view without noise.
ObjectView can_view() {
  return test::view_of(test::cylinder(0.04, 0.12, 64, 8), default_kinect_camera(), test::look_at({0, 0, 0.06}, 0.8, 0.6, 0.3));
}

/// The can's primitive on its place, `margin_m` too large all around.
Placement can_placement(const ObjectView& view, double margin_m) {
  Placement placement;
  placement.primitive = test::can_primitive();
  placement.T_camera_object = view.T_camera_support;
  placement.size_m = Vector3d(0.08, 0.08, 0.12) + 2 * margin_m * Vector3d::Ones();
  return placement;
}

bool is_closed(const FittedModel& model) { return examine_topology(model.mesh_object()).closed; }

// The seen side is drawn in, as far as rule (ii) goes: to about one counting radius from the data. The hidden side stays generic (P17).
TEST(ModelContourPaper, DrawsTheSeenSideInAndLeavesTheHidden) {
  const ObjectView view = can_view();
  const Placement placement = can_placement(view, 0.008);
  ContourTrace trace;
  const FittedModel model = model_contour_paper(view, placement, {}, ContourDirections::kNormal, &trace);
  EXPECT_EQ(model.method, "gfp_paper");
  EXPECT_TRUE(is_closed(model));
  EXPECT_TRUE(model.converged);
  EXPECT_EQ(model.states.size(), model.vertices.size());
  EXPECT_EQ(model.sigma_m.size(), model.vertices.size());
  EXPECT_EQ(static_cast<int>(model.energies.size()), model.iterations + 1);
  EXPECT_EQ(trace.steps.size(), model.energies.size());
  EXPECT_GT(trace.moved_controls, 40);
  EXPECT_GT(trace.frozen, 20);
  const auto rest = shape(*placement.primitive, placement.size_m);
  const Vector3d eye = model.T_camera_object.inverse().translation().normalized();
  int seen = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double radius = model.vertices[i].head<2>().norm();
    const Vector3d outward = Vector3d(rest[i].x(), rest[i].y(), 0).normalized();
    const bool on_side = rest[i].z() > 0.03 && rest[i].z() < 0.1 && rest[i].head<2>().norm() > 0.04;
    if (!on_side) continue;
    if (outward.dot(eye) > 0.5) {
      ++seen;
      EXPECT_NEAR(radius, 0.04, 0.0045) << i;
    }
    if (outward.dot(eye) < -0.3) {
      EXPECT_NEAR((model.vertices[i] - rest[i]).norm(), 0, 1e-12) << i;
      EXPECT_FALSE(model.states[i] & kVertexMoved);
    }
  }
  EXPECT_GT(seen, 20);
  const FittedModel rigid = model_contour_paper(view, placement, {.max_iterations = 0});
  EXPECT_GT(model.evidence.fit_similarity, rigid.evidence.fit_similarity);
}

// 26 directions ask the kd-tree thirteen times as often; the result is a closed model of the same object.
TEST(ModelContourPaper, Grid26IsTheSameContourWithMoreDirections) {
  const ObjectView view = can_view();
  ContourTrace trace;
  const FittedModel model = model_contour_paper(view, can_placement(view, 0.008), {}, ContourDirections::kGrid26, &trace);
  EXPECT_EQ(model.method, "gfp_grid26");
  EXPECT_TRUE(is_closed(model));
  EXPECT_GT(trace.moved_controls, 40);
}

TEST(ModelContourPaper, CountsAreTheSameInTreeAndGrid) {
  const ObjectView view = can_view();
  const Placement placement = can_placement(view, 0.005);
  EXPECT_EQ(model_contour_paper(view, placement, {.kd_tree = true}).vertices, model_contour_paper(view, placement, {.kd_tree = false}).vertices);
}

// The sphere needs no class, takes more iterations than the primitive, and knows nothing of the hidden side: its volume is far off (P29).
TEST(FitSphereSnake, ClosesAroundTheObjectSlowly) {
  const ObjectView view = can_view();
  const FittedModel snake = fit_sphere_snake(view), gfp = model_contour_paper(view, can_placement(view, 0.008));
  EXPECT_EQ(snake.method, "sphere_snake");
  EXPECT_EQ(snake.class_name, "unknown");
  EXPECT_TRUE(is_closed(snake));
  EXPECT_GT(snake.iterations, gfp.iterations);
  const double truth = std::numbers::pi * 0.04 * 0.04 * 0.12;
  EXPECT_GT(std::abs(signed_volume(snake.mesh_object()) - truth), std::abs(signed_volume(gfp.mesh_object()) - truth));
}

TEST(FitSphereSnake, AnswersAViewWithoutPoints) {
  ObjectView view = can_view();
  view.depth_m.pixels.assign(view.depth_m.pixels.size(), 0.0F);
  const FittedModel snake = fit_sphere_snake(view);
  EXPECT_TRUE(is_closed(snake));
  for (const auto& v : snake.mesh_camera().vertices) ASSERT_TRUE(v.allFinite());
}

}  // namespace
}  // namespace gfp
