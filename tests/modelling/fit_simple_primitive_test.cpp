#include "gfp/modelling/fit_simple_primitive.hpp"

#include <gtest/gtest.h>

#include "support/shapes.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

FittedModel fit(const TriangleMesh& mesh_world, double azimuth_rad) {
  return fit_simple_primitive(test::view_of(mesh_world, default_kinect_camera(), test::look_at({0, 0, 0.05}, 0.8, 0.6, azimuth_rad)));
}

// Each of the three shapes is found to be itself: its volume comes back, from any side.
TEST(FitSimplePrimitive, TellsBoxCylinderAndSphereApart) {
  const TriangleMesh box = test::box({0.08, 0.06, 0.11}), can = test::cylinder(0.04, 0.1, 64, 4);
  const TriangleMesh ball = transformed(test::sphere(0.045, 64, 32), Transform(Eigen::Translation3d(0, 0, 0.045)));
  for (const double azimuth : {0.4, 2.0, 4.1}) {
    EXPECT_NEAR(signed_volume(fit(box, azimuth).mesh_object()), 0.08 * 0.06 * 0.11, 0.08 * 0.08 * 0.06 * 0.11) << azimuth;
    EXPECT_NEAR(signed_volume(fit(can, azimuth).mesh_object()), std::numbers::pi * 0.04 * 0.04 * 0.1, 0.08 * std::numbers::pi * 0.04 * 0.04 * 0.1) << azimuth;
    const FittedModel sphere = fit(ball, azimuth);
    EXPECT_NEAR(signed_volume(sphere.mesh_object()), signed_volume(ball), 0.05 * signed_volume(ball)) << azimuth;
    EXPECT_EQ(sphere.method, "simple_primitive");
    EXPECT_EQ(sphere.class_name, "unknown");
    EXPECT_TRUE(examine_topology(sphere.mesh_object()).closed);
    EXPECT_EQ(sphere.evidence.below_support_m, 0);
  }
}

TEST(FitSimplePrimitive, AnswersWithLittleAndWithNothing) {
  ObjectView view = test::view_of(test::box({0.08, 0.06, 0.11}), default_kinect_camera(), test::look_at({0, 0, 0.05}, 0.8, 0.6, 0));
  view.depth_m.pixels.assign(view.depth_m.pixels.size(), 0.0F);
  EXPECT_TRUE(examine_topology(fit_simple_primitive(view).mesh_object()).closed);
  for (std::size_t i = 0; i < view.evidence.pixels.size() && view.object_pixels > 0; ++i)
    if (view.evidence.pixels[i] == Evidence::kObject) {
      view.depth_m.pixels[i] = 0.8F;  // a single point
      break;
    }
  const FittedModel dot = fit_simple_primitive(view);
  for (const auto& v : dot.mesh_camera().vertices) ASSERT_TRUE(v.allFinite());
  EXPECT_FALSE(dot.converged);
}

}  // namespace
}  // namespace gfp
