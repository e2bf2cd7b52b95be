#include "gfp/modelling/fit_multi_superquadric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "gfp/core/self_intersections.hpp"
#include "gfp/modelling/fit_superquadric.hpp"
#include "gfp/modelling/superquadric.hpp"
#include "support/field_surface.hpp"
#include "support/shapes.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

const CameraModel kCamera = default_kinect_camera();

ObjectView view_at(const TriangleMesh& mesh, double elevation_deg, double azimuth_deg, const test::ViewOfMeshOptions& options = {.noise_scale = 1}) {
  constexpr double kDegree = std::numbers::pi / 180;
  return test::view_of(mesh, kCamera, test::look_at({0, 0, 0.5 * bounds(mesh.vertices).high.z()}, 0.8, elevation_deg * kDegree, azimuth_deg * kDegree), options);
}

void expect_sound(const FittedModel& model, const std::string& what) {
  ASSERT_TRUE(model.topology) << what;
  const TriangleMesh mesh = model.mesh_object();
  EXPECT_TRUE(examine_topology(mesh).closed) << what;
  EXPECT_EQ(examine_topology(mesh).components, 1) << what;
  EXPECT_EQ(count_self_intersections(mesh, 1), 0) << what;
  EXPECT_GT(signed_volume(mesh), 0) << what;
  EXPECT_NEAR(bounds(mesh.vertices).low.z(), 0, 1e-9) << what;
  EXPECT_EQ(mesh.vertices.size(), model.states.size()) << what;
  EXPECT_EQ(mesh.vertices.size(), model.sigma_m.size()) << what;
  EXPECT_EQ(model.topology->types.size(), mesh.vertices.size()) << what;
  EXPECT_NE(model.topology->hash, 0U) << what;
}

/// A wide foot with a thin post on it, like a lamp: no single superquadric comes near.
TriangleMesh foot_and_post() {
  const auto field = [](const Vector3d& p) {
    const double foot = std::min(0.05 - std::hypot(p.x(), p.y()), std::min(p.z(), 0.04 - p.z()));
    const double post = std::min(0.016 - std::hypot(p.x(), p.y()), std::min(p.z(), 0.16 - p.z()));
    return std::max(foot, post);
  };
  return test::field_surface(field, {-0.06, -0.06, -0.004}, 0.002, {61, 61, 86});
}

double volume_error(const FittedModel& model, const TriangleMesh& truth) { return std::abs(signed_volume(model.mesh_object()) / signed_volume(truth) - 1); }

TEST(FitMultiSuperquadric, DividesWhatOneBodyCannotExplain) {
  const TriangleMesh lamp = foot_and_post();
  for (const double azimuth : {20.0, 200.0}) {
    const ObjectView view = view_at(lamp, 35, azimuth);
    const FittedModel several = fit_multi_superquadric(view), one = fit_superquadric(view);
    expect_sound(several, std::to_string(azimuth));
    EXPECT_EQ(several.method, "multi_superquadric");
    EXPECT_LT(several.evidence.rms_m, 0.003);
    EXPECT_GT(several.evidence.explained, 0.55);  // the edges of two cylinders are sharper than exponents allow
    EXPECT_LT(one.evidence.explained, 0.1);
    EXPECT_LT(volume_error(several, lamp), 0.3);
  }
}

// What one body explains is not divided: the surface is that body's.
TEST(FitMultiSuperquadric, LeavesWholeWhatOneBodyExplains) {
  Superquadric body{{0.03, 0.04, 0.06}, 0.4, 0.9};
  body.pose.translation().z() = 0.06;
  const TriangleMesh mesh{superquadric_vertices(body), superquadric_topology()->triangles};
  const ObjectView view = view_at(mesh, 30, 50);
  const FittedModel several = fit_multi_superquadric(view), one = fit_superquadric(view);
  expect_sound(several, "one");
  EXPECT_NEAR(signed_volume(several.mesh_object()) / signed_volume(one.mesh_object()), 1, 0.03);
}

TEST(FitMultiSuperquadric, AlwaysReturnsAClosedVolumeAndTheSameOne) {
  const TriangleMesh lamp = foot_and_post();
  ObjectView view = view_at(lamp, 35, 20);
  EXPECT_EQ(fit_multi_superquadric(view).vertices, fit_multi_superquadric(view).vertices);
  expect_sound(fit_multi_superquadric(view_at(lamp, 60, 120, {.noise_scale = 3})), "noisy");
  for (auto& label : view.evidence.pixels)
    if (label == Evidence::kObject) label = Evidence::kUnknown;
  expect_sound(fit_multi_superquadric(view), "nothing seen");
}

}  // namespace
}  // namespace gfp
