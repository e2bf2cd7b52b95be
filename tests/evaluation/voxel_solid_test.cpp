#include "gfp/evaluation/voxel_solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "gfp/core/random.hpp"
#include "surface_voxels_oracle.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

constexpr int kSegments = 96;

double disc_area(double radius) { return 0.5 * kSegments * std::sin(2 * std::numbers::pi / kSegments) * radius * radius; }

// A cup made of cylinders: outer wall, rim, inner wall, floor.
TriangleMesh cup(double radius, double height, double wall, double floor) {
  return test::revolve({{radius, 0}, {radius, height}, {radius - wall, height}, {radius - wall, floor}}, kSegments);
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (auto& v : mesh.vertices) v += by;
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3d& rotation) {
  for (auto& v : mesh.vertices) v = rotation * v;
  return mesh;
}

FilledSolid fill(const TriangleMesh& mesh, double voxel_m = 0.001) {
  auto solid = fill_solid(mesh, voxel_m);
  EXPECT_TRUE(solid.has_value()) << (solid ? "" : solid.error().what);
  return std::move(*solid);
}

// Half a voxel per exposed face is taken off, so that only edges and facets remain of the error: below 0.5 % at 1 mm. The
// faces of the upright box lie along the lattice: each is off by up to half a voxel of 60 to 100.
TEST(FillSolid, VoxelVolumesAreUnbiased) {
  const TriangleMesh box = test::box({0.1003, 0.0801, 0.0607});
  EXPECT_NEAR(fill(box).filled.volume_m3() / signed_volume(box), 1, 0.02);
  const TriangleMesh ball = test::sphere(0.05, 64, 32);
  EXPECT_NEAR(fill(ball).filled.volume_m3() / signed_volume(ball), 1, 0.005);
  const TriangleMesh leaning = turned(box, rotation_from_vector({0.3, 0.5, -0.7}));
  EXPECT_NEAR(fill(leaning).material.volume_m3() / signed_volume(leaning), 1, 0.005);
}

TEST(FilledVolume, IsExactForASolidBodyAndAddsTheCavityOfACup) {
  const TriangleMesh box = test::box({0.1003, 0.0801, 0.0307});
  EXPECT_NEAR(filled_volume_m3(box, fill(box)), signed_volume(box), 1e-15);
  const TriangleMesh mug = cup(0.04, 0.1, 0.0035, 0.0045);
  EXPECT_NEAR(filled_volume_m3(mug, fill(mug)) / (disc_area(0.04) * 0.1), 1, 0.007);
  TriangleMesh two = test::sphere(0.04, 64, 32);  // overlapping parts must not count twice
  append(two, moved(test::sphere(0.04, 64, 32), {0.01, 0, 0}));
  EXPECT_LT(filled_volume_m3(two, fill(two)), 1.3 * signed_volume(test::sphere(0.04, 64, 32)));
}

TEST(FillSolid, ACupIsFilledToItsRimAndItsMaterialIsNot) {
  const double radius = 0.04, height = 0.1, wall = 0.004, floor = 0.005;
  const TriangleMesh mesh = cup(radius, height, wall, floor);
  const FilledSolid solid = fill(mesh);
  EXPECT_NEAR(solid.filled.volume_m3() / (disc_area(radius) * height), 1, 0.01);
  EXPECT_NEAR(solid.material.volume_m3() / signed_volume(mesh), 1, 0.02);
  EXPECT_TRUE(solid.filled.contains({0, 0, 0.09}));
  EXPECT_FALSE(solid.material.contains({0, 0, 0.09}));
  EXPECT_FALSE(solid.filled.contains({0, 0, 0.105}));
}

TEST(FillSolid, AnInvertedCupHoldsNothing) {
  const TriangleMesh mesh = turned(cup(0.04, 0.1, 0.004, 0.005), rotation_from_vector({std::numbers::pi, 0, 0}));
  const FilledSolid solid = fill(mesh);
  EXPECT_EQ(solid.filled.voxels(), solid.material.voxels());
}

TEST(FillSolid, AHandlesHoleStaysOpen) {
  TriangleMesh mug = cup(0.04, 0.1, 0.004, 0.005);
  append(mug, moved(turned(test::torus(0.022, 0.004), rotation_from_vector({std::numbers::pi / 2, 0, 0})), {0.055, 0, 0.05}));
  const FilledSolid solid = fill(mug);
  EXPECT_TRUE(solid.filled.contains({0, 0, 0.05})) << "the cavity";
  EXPECT_FALSE(solid.filled.contains({0.058, 0, 0.05})) << "the handle's hole";
  EXPECT_TRUE(solid.filled.contains({0.077, 0, 0.05})) << "the handle";
}

// A tray of five overlapping boxes whose one side is lower: it holds water up to that side.
TEST(FillSolid, TheLidLiesAtTheRimsLowestPoint) {
  TriangleMesh tray = test::box({0.1, 0.1, 0.004});
  append(tray, moved(test::box({0.004, 0.1, 0.06}), {-0.048, 0, 0}));
  append(tray, moved(test::box({0.004, 0.1, 0.03}), {0.048, 0, 0}));
  append(tray, moved(test::box({0.1, 0.004, 0.06}), {0, -0.048, 0}));
  append(tray, moved(test::box({0.1, 0.004, 0.06}), {0, 0.048, 0}));
  const FilledSolid solid = fill(tray);
  EXPECT_TRUE(solid.filled.contains({0, 0, 0.029}));
  EXPECT_FALSE(solid.filled.contains({0, 0, 0.0325}));
  const double walls_above = 0.03 * (0.1 * 0.1 - 0.092 * 0.092 - 0.004 * 0.092);
  EXPECT_NEAR(solid.filled.volume_m3() / (0.1 * 0.1 * 0.03 + walls_above), 1, 0.01);
}

TEST(FillSolid, InnerShellsAndHairlineCracksDoNotMatter) {
  TriangleMesh nested = test::sphere(0.04, 64, 32);
  append(nested, test::sphere(0.02, 64, 32));
  EXPECT_NEAR(fill(nested).material.volume_m3() / signed_volume(test::sphere(0.04, 64, 32)), 1, 0.005);

  TriangleMesh cracked = test::box({0.06, 0.06, 0.05});  // two open halves, 0.3 mm apart
  std::erase_if(cracked.triangles, [](const Triangle& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; });
  TriangleMesh upper = test::box({0.06, 0.06, 0.05});
  std::erase_if(upper.triangles, [](const Triangle& t) { return t[0] < 4 && t[1] < 4 && t[2] < 4; });
  append(cracked, moved(upper, {0, 0, 0.0503}));
  EXPECT_NEAR(fill(cracked).material.volume_m3() / (0.06 * 0.06 * 0.1003), 1, 0.01);
}

// A pipe of 2.9 mm, two voxels, through the floor of a cup: it runs dry unless pinholes are sealed, and sealing changes nothing else.
TEST(FillSolid, PinholesCanBeSealed) {
  const TriangleMesh leaky = test::revolve({{0.00145, 0}, {0.04, 0}, {0.04, 0.1}, {0.036, 0.1}, {0.036, 0.005}, {0.00145, 0.005}}, kSegments);
  TriangleMesh open = leaky;  // without the fans that revolve() closes the pipe's ends with
  open.triangles.erase(std::remove_if(open.triangles.begin(), open.triangles.end(), [&](const Triangle& t) {
    return *std::max_element(t.begin(), t.end()) >= static_cast<std::int32_t>(open.vertices.size()) - 2; }), open.triangles.end());
  for (std::int32_t s = 0; s < kSegments; ++s) {  // the pipe's wall
    const std::int32_t next = (s + 1) % kSegments, top = 5 * kSegments;
    open.triangles.push_back({s, top + s, next});
    open.triangles.push_back({next, top + s, top + next});
  }
  ASSERT_TRUE(examine_topology(open).closed);
  EXPECT_FALSE(fill(open).filled.contains({0.01, 0, 0.05}));
  const auto sealed = fill_solid(open, 0.001, true);
  ASSERT_TRUE(sealed.has_value());
  EXPECT_NEAR(sealed->filled.volume_m3() / (disc_area(0.04) * 0.1), 1, 0.01);

  const TriangleMesh whole = cup(0.04, 0.1, 0.004, 0.005);
  EXPECT_NEAR(fill_solid(whole, 0.001, true)->filled.volume_m3() / fill(whole).filled.volume_m3(), 1, 0.003);
  EXPECT_NEAR(fill_solid(whole, 0.001, true)->material.volume_m3() / fill(whole).material.volume_m3(), 1, 0.02);
}

// A box with its lid missing is a cup: filled, but not material.
TEST(FillSolid, AnOpenSurfaceIsAThinShell) {
  TriangleMesh open = test::box({0.06, 0.06, 0.05});
  std::erase_if(open.triangles, [](const Triangle& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; });
  const FilledSolid solid = fill(open);
  EXPECT_TRUE(solid.filled.contains({0, 0, 0.025}));
  EXPECT_FALSE(solid.material.contains({0, 0, 0.025}));
}

TEST(FillSolid, RefusesWhatItCannotFill) {
  EXPECT_EQ(fill_solid({}).error().code, ErrorCode::kInvalidArgument);
  TriangleMesh broken = test::box({0.1, 0.1, 0.1});
  EXPECT_EQ(fill_solid(broken, 0).error().code, ErrorCode::kInvalidArgument);
  broken.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fill_solid(broken).error().code, ErrorCode::kInvalidArgument);
  broken.vertices[3].x() = 1e30;
  EXPECT_EQ(fill_solid(broken).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(fill_solid(test::box({3, 3, 3})).error().code, ErrorCode::kTooLarge);
}

TEST(IntersectionOverUnion, OfShiftedBoxesIsTheClosedForm) {
  const TriangleMesh box = test::box({0.1, 0.08, 0.06});
  const auto iou = [&](const Eigen::Vector3d& by) { return intersection_over_union(fill(box).filled, fill(moved(box, by)).filled); };
  EXPECT_EQ(iou({0, 0, 0}), 1.0);
  EXPECT_NEAR(iou({0.02, 0, 0}), 0.08 / 0.12, 0.005);
  EXPECT_NEAR(iou({0, 0.02, 0.03}), (0.06 * 0.03) / (2 * 0.08 * 0.06 - 0.06 * 0.03), 0.01);
  EXPECT_EQ(iou({0.2, 0, 0}), 0.0);
}

// Every voxel the oracle finds by clipping the triangle against the box must be marked, and none that is clearly apart.
TEST(MarkTriangle, AgreesWithClippingTheTriangleToEachVoxel) {
  Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    std::array<Eigen::Vector3d, 3> corners;
    for (auto& corner : corners) corner = {random.uniform(1, 11), random.uniform(1, 11), random.uniform(1, 11)};
    if (trial % 4 == 0) corners[1].z() = corners[2].z() = corners[0].z();  // parallel to a voxel face
    if (trial % 6 == 0) corners[2].x() = corners[1].x() = corners[0].x();
    test::expect_marks_exactly(corners, trial);
  }
}

// The normal's x is below the rounding slack, yet over the row the plane moves by more than that.
TEST(MarkTriangle, FindsTheVoxelsOfATriangleThatLeansByARounding) {
  std::array<Eigen::Vector3d, 3> corners{Eigen::Vector3d(8.85, 1.65, 1), {7.63, 2.27, 1}, {9.25, 9.55, 1 + 1.6e-8}};
  test::expect_marks_exactly(corners, 0);
}

}  // namespace
}  // namespace gfp
