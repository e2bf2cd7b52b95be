#include "gfp/modelling/fit_superquadric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "gfp/modelling/superquadric.hpp"
#include "support/field_surface.hpp"
#include "support/shapes.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

const CameraModel kCamera = default_kinect_camera();
constexpr double kDegree = std::numbers::pi / 180;

ObjectView view_at(const TriangleMesh& mesh, double elevation_deg, double azimuth_deg, const test::ViewOfMeshOptions& options = {.noise_scale = 1}) {
  return test::view_of(mesh, kCamera, test::look_at({0, 0, 0.5 * bounds(mesh.vertices).high.z()}, 0.8, elevation_deg * kDegree, azimuth_deg * kDegree), options);
}

/// What holds of every fit, whatever the view.
void expect_sound(const FittedModel& model, const ObjectView& view, const std::string& what) {
  ASSERT_TRUE(model.topology) << what;
  const TriangleMesh mesh = model.mesh_object();
  ASSERT_EQ(mesh.vertices.size(), model.states.size()) << what;
  ASSERT_EQ(mesh.vertices.size(), model.sigma_m.size()) << what;
  for (const auto& v : mesh.vertices) ASSERT_TRUE(v.allFinite()) << what;
  for (const float sigma : model.sigma_m) ASSERT_TRUE(std::isfinite(sigma) && sigma > 0) << what;
  EXPECT_TRUE(model.T_camera_object.matrix().allFinite()) << what;
  EXPECT_TRUE(examine_topology(mesh).closed) << what;
  EXPECT_EQ(count_self_intersections(mesh, 1), 0) << what;
  EXPECT_GT(signed_volume(mesh), 0) << what;
  EXPECT_NEAR(bounds(mesh.vertices).low.z(), 0, 1e-9) << what;  // the base carries the object's origin
  const Vector3d up = view.T_camera_support.linear().col(2);
  EXPECT_GT(model.T_camera_object.linear().col(2).dot(up), 1 - 1e-9) << what;
  if (!view.has_support) return;
  for (const auto& v : transformed(model.mesh_camera(), view.T_camera_support.inverse()).vertices) ASSERT_GE(v.z(), -1e-9) << what;
}

TriangleMesh standing_superquadric(const Vector3d& half_axes_m, double epsilon1, double epsilon2) {
  Superquadric s{half_axes_m, epsilon1, epsilon2};
  s.pose.translation().z() = half_axes_m.z();
  return {superquadric_vertices(s), superquadric_topology()->triangles};
}

double volume_error(const FittedModel& model, const TriangleMesh& truth) {
  return std::abs(signed_volume(model.mesh_object()) / signed_volume(truth) - 1);
}

// From one side and with Kinect noise the whole body comes back, its unseen back included: the outline says where it ends.
TEST(FitSuperquadric, RecoversBodiesSeenFromOneSide) {
  struct Case {
    Vector3d half_axes_m;
    double epsilon1, epsilon2;
  };
  for (const Case& c : {Case{{0.04, 0.04, 0.06}, 0.1, 1.0}, {{0.05, 0.03, 0.08}, 0.15, 0.15}, {{0.04, 0.04, 0.04}, 1.0, 1.0}, {{0.06, 0.04, 0.05}, 0.7, 0.8}}) {
    for (const double elevation : {25.0, 45.0}) {
      for (const double azimuth : {20.0, 130.0, 260.0}) {
        const std::string what = "epsilon " + std::to_string(c.epsilon1) + ' ' + std::to_string(c.epsilon2) + " elevation " + std::to_string(elevation) + " azimuth " + std::to_string(azimuth);
        const TriangleMesh truth = standing_superquadric(c.half_axes_m, c.epsilon1, c.epsilon2);
        const ObjectView view = view_at(truth, elevation, azimuth);
        const FittedModel model = fit_superquadric(view);
        expect_sound(model, view, what);
        EXPECT_LT(volume_error(model, truth), 0.12) << what;
        const Vector3d expected = 2 * c.half_axes_m;
        EXPECT_NEAR(model.size_m.z(), expected.z(), 0.006) << what;
      }
    }
  }
}

TEST(FitSuperquadric, EveryAlgorithmGivesASoundModel) {
  const TriangleMesh truth = test::cylinder(0.04, 0.12);
  for (const auto algorithm : {SuperquadricAlgorithm::kEmsView, SuperquadricAlgorithm::kEms, SuperquadricAlgorithm::kLevenbergMarquardt}) {
    const ObjectView view = view_at(truth, 35, 40);
    expect_sound(fit_superquadric(view, {.algorithm = algorithm}), view, std::to_string(static_cast<int>(algorithm)));
  }
}

TEST(FitSuperquadric, ALyingCylinderLies) {
  const TriangleMesh standing = test::cylinder(0.03, 0.16);
  Transform lie = Transform::Identity();
  lie.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()).toRotationMatrix();
  lie.translation() = Vector3d(-0.08, 0, 0.03);
  const TriangleMesh truth = transformed(standing, lie);
  const ObjectView view = view_at(truth, 40, 70);
  const FittedModel model = fit_superquadric(view);
  expect_sound(model, view, "lying");
  EXPECT_LT(volume_error(model, truth), 0.15);
  EXPECT_NEAR(model.size_m.x(), 0.16, 0.012);  // the object's x axis runs along it
}

TEST(FitSuperquadric, MarksWhatWasSeen) {
  const TriangleMesh truth = test::box({0.08, 0.06, 0.1});
  const ObjectView view = view_at(truth, 30, 30, {});
  const FittedModel model = fit_superquadric(view);
  const auto mesh = model.mesh_camera();
  const auto normals = vertex_normals(mesh);
  int observed = 0;
  float inferred_sigma = 0, observed_sigma = 1;
  for (std::size_t k = 0; k < model.states.size(); ++k) {
    if (model.states[k] & kVertexObserved) {
      ++observed;
      observed_sigma = std::min(observed_sigma, model.sigma_m[k]);
      EXPECT_LT(normals[k].dot(mesh.vertices[k].normalized()), 0.35) << k;  // an edge's normal may look away a little
    } else {
      inferred_sigma = std::max(inferred_sigma, model.sigma_m[k]);
    }
  }
  EXPECT_GT(observed, 150);
  EXPECT_LT(observed, 500);
  EXPECT_GT(inferred_sigma, 2 * observed_sigma);
}

TEST(FitSuperquadric, IsDeterministic) {
  const ObjectView view = view_at(test::cylinder(0.035, 0.1), 35, 10);
  const FittedModel first = fit_superquadric(view), second = fit_superquadric(view);
  EXPECT_EQ(first.T_camera_object.matrix(), second.T_camera_object.matrix());
  EXPECT_EQ(first.vertices, second.vertices);
}

/// Keeps only the object pixels for which `keep` holds.
template <class Keep>
ObjectView with_object_pixels(ObjectView view, Keep&& keep) {
  view.object_pixels = 0;
  for (int j = 0; j < view.evidence.height; ++j)
    for (int i = 0; i < view.evidence.width; ++i) {
      if (view.evidence.at(i, j) != Evidence::kObject) continue;
      if (keep(i, j)) ++view.object_pixels;
      else view.evidence.at(i, j) = Evidence::kUnknown;
    }
  return view;
}

TEST(FitSuperquadric, DegenerateViewsStillGiveAClosedVolume) {
  const ObjectView whole = view_at(test::box({0.08, 0.06, 0.1}), 30, 30);
  const int middle_i = whole.evidence.width / 2, middle_j = whole.evidence.height / 2;
  const auto check = [](const ObjectView& view, const std::string& what) {
    const FittedModel model = fit_superquadric(view);
    expect_sound(model, view, what);
    EXPECT_LT(model.size_m.maxCoeff(), 0.5) << what;
    return model;
  };
  check(with_object_pixels(whole, [](int, int) { return false; }), "no pixel");
  check(with_object_pixels(whole, [&](int i, int j) { return i == middle_i && j == middle_j; }), "one pixel");
  check(with_object_pixels(whole, [&](int i, int j) { return j == middle_j && i % 2 == 0; }), "a row");
  check(with_object_pixels(whole, [&](int i, int) { return i == middle_i; }), "a column");
  check(with_object_pixels(whole, [&](int i, int j) { return std::abs(i - middle_i) < 2 && std::abs(j - middle_j) < 2; }), "nine pixels");
  ObjectView holes = whole;
  for (std::size_t k = 0; k < holes.depth_m.pixels.size(); ++k)
    if (k % 3 == 0) holes.depth_m.pixels[k] = k % 2 == 0 ? 0.0F : std::numeric_limits<float>::quiet_NaN();
  EXPECT_LT(volume_error(check(holes, "holes and NaN"), test::box({0.08, 0.06, 0.1})), 0.2);
  ObjectView floating = whole;
  floating.has_support = false;
  check(floating, "no support");
  ObjectView tiny;
  tiny.camera = kCamera;
  tiny.tile = {0, 0, 1, 1};
  tiny.depth_m = Image<float>(1, 1);
  tiny.evidence = Image<Evidence>(1, 1);
  tiny.normals = Image<Eigen::Vector3f>(1, 1, Eigen::Vector3f::Zero());
  check(tiny, "one pixel without a reading");
}

// Shapes that are no superquadrics, cluttered and noisy: sound, and around the object.
TEST(FitSuperquadric, StaysAroundOddObjects) {
  const TriangleMesh ring = transformed(test::torus(0.06, 0.02), Transform(Eigen::Translation3d(0, 0, 0.02)));
  TriangleMesh cross = test::box({0.2, 0.03, 0.03});
  append(cross, test::box({0.03, 0.2, 0.03}));
  for (const auto& mesh : {ring, cross, test::box({0.3, 0.2, 0.004}), test::cylinder(0.004, 0.15)}) {
    for (const double elevation : {15.0, 40.0, 80.0}) {
      const ObjectView view = view_at(mesh, elevation, 25, {.noise_scale = 1, .others_world = {transformed(test::box({0.05, 0.05, 0.1}), Transform(Eigen::Translation3d(0.12, 0.08, 0)))}});
      const FittedModel model = fit_superquadric(view);
      expect_sound(model, view, std::to_string(elevation));
      EXPECT_LT(model.size_m.maxCoeff(), 0.6) << elevation;
    }
  }
}

// A seat on a thin post: no convex body explains it. What it gets is at least where it is.
TEST(FitSuperquadric, WhatNoBodyExplainsGetsTheBoxAboutIt) {
  const auto field = [](const Vector3d& p) {
    const double seat = std::min({0.18 - std::abs(p.x()), 0.18 - std::abs(p.y()), p.z() - 0.36, 0.40 - p.z()});
    const double post = std::min({0.02 - std::abs(p.x()), 0.02 - std::abs(p.y()), p.z(), 0.38 - p.z()});
    return std::max(seat, post);
  };
  const TriangleMesh stool = test::field_surface(field, {-0.22, -0.22, -0.02}, 0.008, {56, 56, 58});
  for (const double elevation : {15.0, 30.0}) {
    const ObjectView view = view_at(stool, elevation, 25);
    const FittedModel model = fit_superquadric(view);
    expect_sound(model, view, std::to_string(elevation));
    const Bounds found = bounds(transformed(model.mesh_camera(), view.T_camera_support.inverse()).vertices);
    EXPECT_LT((found.centre() - bounds(stool.vertices).centre()).norm(), 0.12) << elevation;
    EXPECT_GT(model.evidence.silhouette_iou, 0.2) << elevation;  // a box covers far more than a seat and a post
  }
}

}  // namespace
}  // namespace gfp
