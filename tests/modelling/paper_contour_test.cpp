// The paper's active contour, rule by rule (P17-P27); printed forms that do not do what the text says stand beside.
#include "modelling/paper_contour.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gfp/core/random.hpp"
#include "gfp/modelling/superquadric.hpp"
#include "modelling/density_rules.hpp"
#include "modelling/linear_law.hpp"
#include "modelling/paper_energy.hpp"
#include "modelling/point_count.hpp"
#include "support/printed_forms.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A 1.5 mm lattice on the plane x = `at_m`, `half_m` to every side.
std::vector<Vector3f> wall(double at_m, double half_m) {
  std::vector<Vector3f> points;
  for (double y = -half_m; y <= half_m; y += 0.0015)
    for (double z = -half_m; z <= half_m; z += 0.0015) points.emplace_back(static_cast<float>(at_m), static_cast<float>(y), static_cast<float>(z));
  return points;
}

TriangleMesh ball(double radius_m, const Vector3d& centre = Vector3d::Zero()) {
  Superquadric sphere{Vector3d::Constant(radius_m), 1, 1, Transform(Eigen::Translation3d(centre))};
  return {superquadric_vertices(sphere), superquadric_topology()->triangles};
}

std::vector<Vector3f> points_on_ball(double radius_m, int count) {
  std::vector<Vector3f> points;
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, angle = k * 2.399963229728653, across = std::sqrt(1 - z * z);
    points.push_back((radius_m * Vector3d(across * std::cos(angle), across * std::sin(angle), z)).cast<float>());
  }
  return points;
}

constexpr float kRadius = 0.0027F;

// P24: the kd-tree of the paper and our grid are one and the same field.
TEST(PointCount, KdTreeAndVoxelGridAgree) {
  Random random(3);
  std::vector<Vector3f> points;
  for (int i = 0; i < 3000; ++i) points.emplace_back(static_cast<float>(random.uniform(0, 0.05)), static_cast<float>(random.uniform(0, 0.05)), static_cast<float>(random.uniform(0.8, 0.82)));
  const PointCount tree = count_by_kd_tree(points, kRadius), grid = count_by_voxel_grid(points, kRadius);
  int counted = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3f place(static_cast<float>(random.uniform(-0.01, 0.06)), static_cast<float>(random.uniform(-0.01, 0.06)), static_cast<float>(random.uniform(0.79, 0.83)));
    ASSERT_EQ(tree(place), grid(place));
    counted += grid(place);
  }
  EXPECT_GT(counted, 1000);
  EXPECT_EQ(count_by_kd_tree({}, kRadius)({0, 0, 0}), 0);
  EXPECT_EQ(count_by_voxel_grid({}, kRadius)({0, 0, 0}), 0);
}

// Rule (ii): from nothing to the nearest place with points, one radius before the surface; too far away, the control freezes.
TEST(DensityRules, GoToTheNearestPointsAndFreezeWithout) {
  const PointCount count = count_by_voxel_grid(wall(0.0105, 0.02), kRadius);
  const auto outward = best_candidate({0, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.02);
  ASSERT_TRUE(outward);
  EXPECT_NEAR(outward->x(), 0.008, 1e-12);  // 2.5 mm before the wall is the first millimetre within 2.7 mm of it
  const auto inward = best_candidate({0.02, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.02);
  ASSERT_TRUE(inward);
  EXPECT_NEAR(inward->x(), 0.013, 1e-12);
  EXPECT_FALSE(best_candidate({0, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.007));
  EXPECT_FALSE(best_candidate({0, 0, 0}, normal_directions({0, 1, 0}), count, 0.001, 0.05));
}

// Rule (i): out of a dense region to the nearest place without points, the way out first: this leaves the surface by about one radius.
TEST(DensityRules, LeaveADenseRegionByOneRadius) {
  const PointCount count = count_by_voxel_grid(wall(0, 0.02), kRadius);
  const auto tie = best_candidate({0, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.02);
  ASSERT_TRUE(tie);
  EXPECT_NEAR(tie->x(), 0.003, 1e-12);
  const auto nearer = best_candidate({-0.001, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.02);
  EXPECT_NEAR(nearer->x(), -0.003, 1e-12);
  const auto sparsest = best_candidate({0, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.002);  // no empty place in reach
  ASSERT_TRUE(sparsest);
  EXPECT_NEAR(sparsest->x(), 0.002, 1e-12);
}

// A grid's 26 directions find what the normal misses.
TEST(DensityRules, TwentySixDirectionsLookAside) {
  const auto directions = grid_directions({1, 0, 0});
  ASSERT_EQ(directions.size(), 26U);
  EXPECT_EQ(directions.front(), Vector3d(1, 0, 0));
  const PointCount count = count_by_voxel_grid(std::vector<Vector3f>{{0, 0.01F, 0}}, kRadius);
  EXPECT_FALSE(best_candidate({0, 0, 0}, normal_directions({1, 0, 0}), count, 0.001, 0.02));
  const auto aside = best_candidate({0, 0, 0}, directions, count, 0.001, 0.02);
  ASSERT_TRUE(aside);
  EXPECT_NEAR((*aside - Vector3d(0, 0.008, 0)).norm(), 0, 1e-12);
}

// P26, the sensible form: p' = p + D (1 - d / d_max) with d along the surface, on a straight strip where d is plain to see.
TEST(LinearLaw, DragsLessTheFartherAway) {
  TriangleMesh strip;
  for (int i = 0; i < 12; ++i) {
    strip.vertices.emplace_back(0.01 * i, 0, 0);
    strip.vertices.emplace_back(0.01 * i, 0.01, 0);
  }
  for (std::int32_t i = 0; i + 3 < 24; i += 2) {
    strip.triangles.push_back({i, i + 2, i + 1});
    strip.triangles.push_back({i + 1, i + 2, i + 3});
  }
  std::vector<std::uint8_t> is_control(24, 0);
  is_control[0] = 1;
  const double edge_m = 0.01;
  for (const double length : {0.005, 0.05}) {
    std::vector<Vector3d> u(24, Vector3d::Zero());
    u[0] = {0, 0, length};
    LinearLaw(strip, is_control, edge_m, length).drag(u);
    const double d_max = std::max(length, 2 * edge_m);
    for (std::size_t i = 2; i < 24; i += 2) {
      const double d = 0.01 * static_cast<double>(i / 2);
      EXPECT_NEAR(u[i].z(), d < d_max ? length * (1 - d / d_max) : 0.0, 1e-12) << i;
    }
    // Printed, the law moves what is far most, and along its own coordinates.
    const Vector3d near(0.01, 0, 0), far(0.04, 0, 0);
    EXPECT_GT((test::printed::drag(far, 0.04, 0.05) - far).norm(), (test::printed::drag(near, 0.01, 0.05) - near).norm());
    EXPECT_EQ(test::printed::drag(Vector3d::Zero(), 0.03, 0.05), Vector3d::Zero());
  }
}

// Several controls: between equal displacements nothing dips, and the order of the controls does not matter.
TEST(LinearLaw, BlendsWithoutRipplesOrOrder) {
  const TriangleMesh sphere = ball(0.05);
  std::vector<std::uint8_t> is_control(sphere.vertices.size(), 0);
  for (std::size_t i = 0; i < is_control.size(); i += 3) is_control[i] = 1;
  std::vector<Vector3d> u(sphere.vertices.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < u.size(); ++i)
    if (is_control[i] != 0) u[i] = {0, 0, 0.02};
  LinearLaw(sphere, is_control, mean_edge_length(sphere), 0.02).drag(u);
  for (const auto& displacement : u) EXPECT_NEAR(displacement.z(), 0.02, 0.001);
}

// The distance runs along the surface: pulling at the outer wall of a cup leaves the inner wall, 3 mm away, where it is.
TEST(LinearLaw, DoesNotReachThroughAWall) {
  TriangleMesh walls = ball(0.05);
  const auto outer = static_cast<std::int32_t>(walls.vertices.size());
  append(walls, ball(0.047));
  std::vector<std::uint8_t> is_control(walls.vertices.size(), 0);
  is_control[10] = 1;
  std::vector<Vector3d> u(walls.vertices.size(), Vector3d::Zero());
  u[10] = {0.01, 0, 0};
  LinearLaw(walls, is_control, mean_edge_length(walls), 0.01).drag(u);
  for (std::size_t i = static_cast<std::size_t>(outer); i < u.size(); ++i) ASSERT_EQ(u[i], Vector3d::Zero());
}

// P20, P21: energies are changes from rest. Printed, they are not zero at rest, so that the contour would shrink and lose its corners.
TEST(PaperEnergy, IsZeroAtRestAndForMotions) {
  const TriangleMesh sphere = ball(0.05);
  const VertexAdjacency adjacency = vertex_adjacency(sphere);
  std::vector<Vector3d> u(sphere.vertices.size(), Vector3d(0.003, -0.002, 0.001));
  const InternalEnergy moved = internal_energy(adjacency, u, 100, u[100]);
  EXPECT_NEAR(moved.continuity, 0, 1e-20);
  EXPECT_NEAR(moved.curvature, 0, 1e-20);
  const InternalEnergy pulled = internal_energy(adjacency, u, 100, u[100] + Vector3d(0, 0, 0.004));
  EXPECT_NEAR(pulled.continuity, 0.004 * 0.004, 1e-12);
  EXPECT_NEAR(pulled.curvature, 0.004 * 0.004, 1e-12);

  const Vector3d corner(0, 0, 0), along_s(-0.01, 0, 0), along_r(0, -0.01, 0);
  EXPECT_GT(test::printed::continuity(corner, along_s, along_r), 0) << "a flat sheet at rest";
  EXPECT_GT(test::printed::mixed_curvature(along_s, corner, along_r), 0) << "a corner at rest";
  // The surface z = x y bends by its mixed derivative alone; the printed term cannot see it along s or r, where it is straight.
  const auto saddle = [](double x, double y) { return Vector3d(x, y, x * y); };
  EXPECT_EQ(test::printed::mixed_curvature(saddle(-1, 0), saddle(0, 0), saddle(1, 0)), 0);
}

TEST(Gate, OpensAboveItsThresholdAndKeepsItsStateNearIt) {
  Gate gate;
  EXPECT_FALSE(gate.update(1.05));
  EXPECT_TRUE(gate.update(1.2));
  EXPECT_TRUE(gate.update(0.95));
  EXPECT_FALSE(gate.update(0.8));
}

// A ball of 50 mm among the points of one of 56 mm: every control steps out, a millimetre at a time, and ends one radius short.
TEST(PaperContour, StepsOntoALargerBall) {
  const auto points = points_on_ball(0.056, 12'000);
  const ContourStart start{ball(0.05), std::vector<std::uint8_t>(610, 1), 0.0125};
  for (const auto& count : {count_by_voxel_grid(points, kRadius), count_by_kd_tree(points, kRadius)}) {
    const ContourEnd end = run_paper_contour(start, count, {}, ContourDirections::kNormal);
    EXPECT_TRUE(end.converged);
    EXPECT_EQ(end.trace.controls, 610);
    EXPECT_EQ(end.trace.frozen, 0);
    EXPECT_EQ(end.trace.moved_controls, 610);
    EXPECT_EQ(end.trace.steps.size(), 5U);  // the start and four millimetres
    for (const auto& v : end.vertices) EXPECT_NEAR(v.norm(), 0.054, 0.0011);
    for (std::size_t k = 1; k < end.trace.steps.size(); ++k) EXPECT_LT(end.trace.steps[k].energy(), end.trace.steps[k - 1].energy()) << k;
    EXPECT_EQ(end.trace.steps.back().settled, 610);
    EXPECT_NEAR(end.trace.steps.back().external, 0, 1e-9);
  }
}

// Data on one half only: the other half keeps its first place (P17), and no triangle of it moves.
TEST(PaperContour, FreezesWhereNothingIsSeen) {
  std::vector<Vector3f> half;
  for (const auto& p : points_on_ball(0.056, 12'000))
    if (p.x() > 0) half.push_back(p);
  const ContourStart start{ball(0.05), std::vector<std::uint8_t>(610, 1), 0.0125};
  const ContourEnd end = run_paper_contour(start, count_by_voxel_grid(half, kRadius), {}, ContourDirections::kNormal);
  EXPECT_NEAR(end.trace.frozen, 305, 40);
  EXPECT_EQ(end.trace.moved_regulars, 0);
  for (std::size_t i = 0; i < end.vertices.size(); ++i) {
    if (start.mesh.vertices[i].x() < -0.01) {
      EXPECT_EQ(end.vertices[i], start.mesh.vertices[i]);
    }
  }
}

// A single control among still neighbours is held by gate beta once it has left them by about half an edge.
TEST(PaperContour, InternalEnergyHoldsALonelyControl) {
  const TriangleMesh sphere = ball(0.05);
  std::vector<std::uint8_t> is_control(610, 0);
  is_control[300] = 1;
  const Vector3d place = sphere.vertices[300];
  const std::vector<Vector3f> far{(1.5 * place).cast<float>()};
  PaperContourOptions free;
  free.continuity_edges = free.curvature_edges = 100;
  const ContourStart start{sphere, is_control, 0.03};
  const PointCount count = count_by_voxel_grid(far, kRadius);
  const double reached = (run_paper_contour(start, count, free, ContourDirections::kNormal).vertices[300] - place).norm();
  EXPECT_NEAR(reached, 0.023, 0.0011);
  PaperContourOptions stiff;
  stiff.curvature_edges = 0.1;
  EXPECT_LT((run_paper_contour(start, count, stiff, ContourDirections::kNormal).vertices[300] - place).norm(), 0.5 * reached);
}

TEST(PaperContour, WithoutPointsNothingMoves) {
  const ContourStart start{ball(0.05), std::vector<std::uint8_t>(610, 1), 0.0125};
  const ContourEnd end = run_paper_contour(start, count_by_kd_tree({}, kRadius), {}, ContourDirections::kGrid26);
  EXPECT_TRUE(end.converged);
  EXPECT_EQ(end.trace.frozen, 610);
  EXPECT_EQ(end.trace.steps.size(), 1U);
  EXPECT_EQ(end.vertices, start.mesh.vertices);
}

// P15 and P28: what eqs. 1 and 8 say as printed.
TEST(PrintedForms, Equation1MovesByTheScaledAndTurnedTranslation) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Vector3d T(0.1, 0, 0), centre(0, 0, 0);
  EXPECT_TRUE(test::printed::place(centre, 2, R, T).isApprox(Vector3d(0, 0.2, 0)));  // the centre of mass should have come to T
}

TEST(PrintedForms, Equation8IsOneForAPerfectFit) {
  EXPECT_EQ(test::printed::fit_error(0, 4e4), 1);
  EXPECT_LT(test::printed::fit_error(0.01, 4e4), 0.5);
}

}  // namespace
}  // namespace gfp
