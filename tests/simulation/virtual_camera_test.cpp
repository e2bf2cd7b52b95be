#include "gfp/simulation/virtual_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/shapes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

VirtualScene scene_with(TriangleMesh mesh, const Vector3d& at = Vector3d::Zero()) {
  VirtualScene scene;
  PlacedMesh object{"thing_00", "thing", std::move(mesh), Transform::Identity(), Rgb8{200, 60, 50}};
  object.T_world_object.translation() = at;
  scene.objects.push_back(std::move(object));
  return scene;
}

Transform usual_pose() { return look_at_pose({0, 0, 0.05}, 0.9, 40 * kDegree, -90 * kDegree); }

VirtualCameraOptions perfect() {
  VirtualCameraOptions options;
  options.noise_scale = 0;
  return options;
}

Vector3d world_point(const Capture& c, int u, int v) {
  return c.truth.T_world_camera * (c.truth.depth_m.at(u, v) * c.frame.camera.ray(u, v));
}

TEST(LookAtPose, PutsTheTargetOnTheAxisWithTheHorizonLevel) {
  for (const double elevation : {5.0, 40.0, 90.0})
    for (const double azimuth : {-170.0, 0.0, 33.0}) {
      const Vector3d target(0.1, -0.2, 0.3);
      const Transform T = look_at_pose(target, 0.8, elevation * kDegree, azimuth * kDegree);
      EXPECT_TRUE((T.inverse() * target).isApprox(Vector3d(0, 0, 0.8), 1e-12));
      EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
      EXPECT_NEAR(T.linear().col(0).z(), 0, 1e-12);   // right is level
      EXPECT_LE(T.linear().col(1).z(), 1e-12);        // down is not up
      EXPECT_NEAR(T.translation().z() - target.z(), 0.8 * std::sin(elevation * kDegree), 1e-12);
    }
}

// Every truth pixel lies on the surface that its label names, to the float that carries it.
TEST(Capture, TruthLiesOnTheNamedSurfaces) {
  const double radius = 0.06;
  const VirtualScene scene = scene_with(test::sphere(radius, 128, 64), {0.05, 0.02, radius});
  const Capture c = capture(scene, default_kinect_camera(), usual_pose(), perfect(), 1);
  int table = 0, object = 0, background = 0;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      const Vector3d p = world_point(c, u, v);
      switch (c.truth.labels.at(u, v)) {
        case 0: ++object; EXPECT_NEAR((p - Vector3d(0.05, 0.02, radius)).norm(), radius, 2e-4); break;  // chords of the tessellation
        case -2: {
          ++table;
          const bool on_top = std::abs(p.z()) < 1e-5, on_side = p.z() < 0 && p.z() > -0.0301;
          EXPECT_TRUE(on_top || on_side) << u << ' ' << v << ' ' << p.transpose();
          EXPECT_LE(std::abs(p.x()), scene.table_half_x_m + 1e-5);
          break;
        }
        default:
          ++background;
          if (c.truth.depth_m.at(u, v) > 0) {
            EXPECT_LT(std::min(std::abs(p.z() - scene.floor_z_m), std::abs(p.y() - scene.wall_y_m)), 1e-4);
          }
      }
    }
  EXPECT_GT(object, 3000);
  EXPECT_GT(table, 100'000);
  EXPECT_GT(background, 10'000);
}

TEST(Capture, APerfectCameraMeasuresTheTruth) {
  const Capture c = capture(scene_with(test::box({0.1, 0.1, 0.1})), default_kinect_camera(), usual_pose(), perfect(), 1);
  ASSERT_EQ(c.frame.depth.scale_m, 1e-4);
  for (std::size_t i = 0; i < c.truth.depth_m.pixels.size(); ++i)
    ASSERT_NEAR(c.frame.depth.pixels.pixels[i] * 1e-4, c.truth.depth_m.pixels[i], 0.5e-4 + 1e-6);
}

TEST(Capture, SameSeedSameBytesOtherSeedOtherNoise) {
  const VirtualScene scene = scene_with(test::cylinder(0.04, 0.12));
  const auto shot = [&](std::uint64_t seed) { return capture(scene, default_kinect_camera(), usual_pose(), {}, seed).frame; };
  EXPECT_EQ(shot(7).depth.pixels.pixels, shot(7).depth.pixels.pixels);
  EXPECT_EQ(shot(7).color.pixels, shot(7).color.pixels);
  EXPECT_NE(shot(7).depth.pixels.pixels, shot(8).depth.pixels.pixels);
}

TEST(Capture, PosesAreThoseOfTheCameraFrame) {
  const VirtualScene scene = scene_with(test::box({0.1, 0.1, 0.1}), {0.2, -0.1, 0});
  const Capture c = capture(scene, default_kinect_camera(), usual_pose(), {}, 1);
  ASSERT_EQ(c.truth.T_camera_object.size(), 1U);
  EXPECT_TRUE((c.truth.T_world_camera * c.truth.T_camera_object[0]).isApprox(scene.objects[0].T_world_object, 1e-12));
  EXPECT_TRUE(c.frame.T_world_sensor.isApprox(usual_pose()));
}

struct Residuals {
  double mean_m = 0, sigma_m = 0, column_correlation = 0, row_correlation = 0;
  int readings = 0;
};

/// Noise on a patch of the table about its middle, seen from straight above at `height_m`.
Residuals table_noise(double height_m, const VirtualCameraOptions& options) {
  VirtualScene scene;
  scene.table_half_x_m = scene.table_half_y_m = 5;
  Residuals r;
  double squares = 0, columns = 0, rows = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const double height = height_m + 0.0011 * static_cast<double>(seed);  // a few disparity steps: one alone would be biased
    const Capture c = capture(scene, default_kinect_camera(), look_at_pose(Vector3d::Zero(), height, 90 * kDegree, 0), options, seed);
    const auto error = [&](int u, int v) { return c.frame.depth.pixels.at(u, v) * c.frame.depth.scale_m - c.truth.depth_m.at(u, v); };
    for (int v = 180; v < 300; ++v)
      for (int u = 240; u < 400; ++u) {
        if (c.frame.depth.pixels.at(u, v) == 0) continue;
        ++r.readings;
        r.mean_m += error(u, v);
        squares += error(u, v) * error(u, v);
        columns += error(u, v) * error(u + 1, v);
        rows += error(u, v) * error(u, v + 1);
      }
  }
  r.mean_m /= r.readings;
  r.sigma_m = std::sqrt(squares / r.readings);
  r.column_correlation = columns / squares;
  r.row_correlation = rows / squares;
  return r;
}

// The noise that the frame states is the noise that it has, steps and rounding included. Steps of about 2 mm whose depths are
// rounded to whole millimetres keep nearly the same rounding error over many steps, as in a real Kinect: half a millimetre at most.
TEST(Capture, NoiseHasTheStatedSigma) {
  const VirtualCameraOptions options;
  for (const double z : {0.6, 0.8, 1.2, 1.6}) {
    const Residuals r = table_noise(z, options);
    EXPECT_EQ(r.readings, 8 * 120 * 160);
    EXPECT_NEAR(r.sigma_m, options.noise.sigma_m(z), 0.2 * options.noise.sigma_m(z)) << z;
    EXPECT_NEAR(r.mean_m, 0, 0.0005) << z;
  }
}

TEST(Capture, NoiseWithoutStepsHasNoBias) {
  VirtualCameraOptions options;
  options.disparity_step_px = 0;
  for (const double z : {0.6, 0.8, 1.2, 1.6}) {
    const Residuals r = table_noise(z, options);
    EXPECT_NEAR(r.mean_m, 0, 0.0001) << z;  // four sigma of a mean over 150 000 correlated readings
    EXPECT_NEAR(r.sigma_m, options.noise.sigma_m(z), 0.06 * options.noise.sigma_m(z)) << z;
  }
}

// Measured on the planes of real Kinect frames: 0.73 over one column, 0.57 over one row.
TEST(Capture, NoiseIsCorrelatedAsAKinects) {
  const Residuals r = table_noise(0.9, {});
  EXPECT_NEAR(r.column_correlation, 0.73, 0.1);
  EXPECT_NEAR(r.row_correlation, 0.57, 0.1);
}

TEST(Capture, NoiseScaleScalesTheNoise) {
  VirtualCameraOptions half, full;
  half.disparity_step_px = full.disparity_step_px = 0;
  half.noise_scale = 0.5;
  EXPECT_NEAR(table_noise(1.2, half).sigma_m / table_noise(1.2, full).sigma_m, 0.5, 0.03);
}

/// Pixels of the row through the box's middle that have no reading although something is there.
int dark_pixels(const Capture& c, int v, int from_u, int to_u) {
  int dark = 0;
  for (int u = from_u; u < to_u; ++u) dark += c.frame.depth.pixels.at(u, v) == 0 && c.truth.depth_m.at(u, v) > 0 ? 1 : 0;
  return dark;
}

// A projector to the right leaves a shadow on the left, as wide as the disparities of box top and table differ: f B (1/z1 - 1/z2).
TEST(Capture, ShadowLiesLeftOfObjectsAndIsAsWideAsTheDisparityStep) {
  VirtualCameraOptions options;
  options.noise_scale = 1e-3;
  const Capture c = capture(scene_with(test::box({0.1, 0.1, 0.1})), default_kinect_camera(), look_at_pose(Vector3d::Zero(), 0.9, 90 * kDegree, -90 * kDegree), options, 1);
  const double expected = 525 * 0.075 * (1 / 0.8 - 1 / 0.9);
  const int left_edge = static_cast<int>(319.5 - 525 * 0.05 / 0.8), right_edge = static_cast<int>(319.5 + 525 * 0.05 / 0.8);
  EXPECT_NEAR(dark_pixels(c, 240, left_edge - 20, left_edge + 2), expected, 1.6);
  EXPECT_LE(dark_pixels(c, 240, right_edge - 2, right_edge + 20), 1);
  VirtualCameraOptions none = options;
  none.shadow_baseline_m = 0;
  const Capture lit = capture(scene_with(test::box({0.1, 0.1, 0.1})), default_kinect_camera(), look_at_pose(Vector3d::Zero(), 0.9, 90 * kDegree, -90 * kDegree), none, 1);
  EXPECT_EQ(dark_pixels(lit, 240, 0, 640), 0);
}

// A cylinder's flanks turn away from the camera: towards its outline there must be no reading, in the middle there must.
TEST(Capture, GrazingSurfacesHaveNoReading) {
  VirtualCameraOptions options;
  options.shadow_baseline_m = 0;
  options.edge_jitter_px = 0;
  options.grazing_dropout_deg = 70;
  const Capture c = capture(scene_with(test::cylinder(0.1, 0.4, 256, 4)), default_kinect_camera(), look_at_pose({0, 0, 0.2}, 0.9, 5 * kDegree, -90 * kDegree), options, 1);
  int left = 320, right = 320;
  while (c.truth.labels.at(left - 1, 240) == 0) --left;
  while (c.truth.labels.at(right + 1, 240) == 0) ++right;
  EXPECT_EQ(c.frame.depth.pixels.at(left, 240), 0);
  EXPECT_EQ(c.frame.depth.pixels.at(right, 240), 0);
  EXPECT_NE(c.frame.depth.pixels.at(320, 240), 0);
  // sin 70 deg = 0.94 of the radius, plus up to 5 degrees of raggedness: 3 to 12 % of each half width are dark.
  const int dark = dark_pixels(c, 240, left, right + 1);
  EXPECT_GT(dark, 0.03 * (right - left));
  EXPECT_LT(dark, 0.16 * (right - left));
}

TEST(Capture, SilhouettesWaver) {
  VirtualCameraOptions options;
  options.shadow_baseline_m = 0;
  const VirtualScene scene = scene_with(test::box({0.2, 0.2, 0.2}));
  const Transform above = look_at_pose(Vector3d::Zero(), 0.9, 90 * kDegree, -90 * kDegree);
  const auto wrong_side = [&](double jitter_px) {
    options.edge_jitter_px = jitter_px;
    const Capture c = capture(scene, default_kinect_camera(), above, options, 1);
    int count = 0;
    for (std::size_t i = 0; i < c.truth.depth_m.pixels.size(); ++i)
      count += std::abs(c.frame.depth.pixels.pixels[i] * 1e-3 - c.truth.depth_m.pixels[i]) > 0.1 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(wrong_side(0), 0);
  EXPECT_GT(wrong_side(0.5), 50);
  EXPECT_LT(wrong_side(0.5), 900);  // the outline is 600 pixels long, and each of its sides may be wrong
}

TEST(Capture, WorksInsideOddRooms) {
  VirtualScene empty;
  empty.wall_y_m = INFINITY;
  empty.table_half_x_m = empty.table_half_y_m = 3;  // reaches behind the camera
  const Capture low = capture(empty, default_kinect_camera(64, 48), look_at_pose(Vector3d::Zero(), 0.9, 10 * kDegree, 0), {}, 1);
  EXPECT_EQ(low.truth.labels.at(32, 40), -2);
  EXPECT_EQ(low.truth.depth_m.at(32, 0) > 0, false);  // above the horizon there is nothing
  const Capture one = capture(empty, {1, 1, 500, 500, 0, 0, DistortionModel::kNone, {}}, usual_pose(), {}, 1);
  EXPECT_EQ(one.frame.depth.pixels.pixels.size(), 1U);
}

TEST(Capture, ColourShowsObjectTableAndShape) {
  const Capture c = capture(scene_with(test::sphere(0.06), {0, 0, 0.06}), default_kinect_camera(), usual_pose(), {}, 1);
  const Eigen::Vector2d centre = c.frame.camera.project(c.truth.T_camera_object[0].translation());
  const auto u = static_cast<int>(centre.x()), v = static_cast<int>(centre.y());
  const Rgb8 lit = c.frame.color.at(u - 8, v - 12), dark = c.frame.color.at(u + 12, v + 12);
  EXPECT_GT(lit.r, 2 * lit.g);        // the object's own red
  EXPECT_GT(lit.r, dark.r + 10);      // the lamp is above on the left
  VirtualCameraOptions no_color;
  no_color.color = false;
  EXPECT_TRUE(capture(VirtualScene{}, default_kinect_camera(), usual_pose(), no_color, 1).frame.color.empty());
}

}  // namespace
}  // namespace gfp
