#include "gfp/modelling/superquadric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

Transform random_pose(Random& random) {
  Transform pose = Transform::Identity();
  pose.linear() = rotation_from_vector(3 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  pose.translation() = Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.5, 2));
  return pose;
}

/// Half axes from 3 mm to 300 mm, exponents over their whole range, sharp ones often.
Superquadric random_superquadric(Random& random) {
  Superquadric s;
  for (int k = 0; k < 3; ++k) s.half_axes_m[k] = 0.003 * std::pow(100.0, random.uniform());
  s.epsilon1 = random.below(4) == 0 ? random.uniform(0.01, 0.2) : random.uniform(0.2, 2.0);
  s.epsilon2 = random.below(4) == 0 ? random.uniform(0.01, 0.2) : random.uniform(0.2, 2.0);
  s.pose = random_pose(random);
  return s;
}

Vector3d around(Random& random, const Superquadric& s, double reach_factor) {
  const Vector3d unit(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return s.pose * Vector3d(reach_factor * unit.cwiseProduct(s.half_axes_m));
}

// The printed formula, where it does not overflow, is the oracle of the nested norms.
TEST(Superquadric, InsideOutsideIsBarrsFormula) {
  Random random(11);
  for (int trial = 0; trial < 1000; ++trial) {
    Superquadric s = random_superquadric(random);
    s.epsilon1 = std::max(s.epsilon1, 0.2);
    s.epsilon2 = std::max(s.epsilon2, 0.2);
    const Vector3d point = around(random, s, 1.5);
    const Vector3d q = (s.pose.inverse() * point).cwiseQuotient(s.half_axes_m).cwiseAbs();
    const double across = std::pow(q.x(), 2 / s.epsilon2) + std::pow(q.y(), 2 / s.epsilon2);
    const double expected = std::pow(across, s.epsilon2 / s.epsilon1) + std::pow(q.z(), 2 / s.epsilon1);
    EXPECT_NEAR(inside_outside(s, point), expected, 1e-9 * (1 + expected)) << trial;
  }
}

TEST(Superquadric, IsASphereWhenItIsOne) {
  Superquadric s;
  s.half_axes_m.setConstant(0.05);
  s.pose.translation() = Vector3d(0.1, -0.2, 0.8);
  Random random(12);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d point = around(random, s, 2);
    const double expected = (point - s.pose.translation()).norm() - 0.05;
    EXPECT_NEAR(radial_distance(s, point), expected, 1e-12);
    EXPECT_NEAR(surface_distance(s, point), expected, 1e-12);
  }
  EXPECT_NEAR(volume(s), 4.0 / 3.0 * std::numbers::pi * std::pow(0.05, 3), 1e-12);
}

// Sharp bodies are where the printed form overflows: far away, F is above 1e308.
TEST(Superquadric, StaysFiniteForSharpBodiesFarAway) {
  Superquadric box;
  box.half_axes_m = Vector3d(0.05, 0.03, 0.1);
  box.epsilon1 = box.epsilon2 = 0.01;
  EXPECT_NEAR(gauge(box, Vector3d(5, 1, 2)), 100, 1e-6);
  EXPECT_NEAR(surface_distance(box, Vector3d(5, 0.01, 0.02)), 4.95, 1e-9);
  EXPECT_NEAR(volume(box), 8 * 0.05 * 0.03 * 0.1, 1e-3 * 8 * 0.05 * 0.03 * 0.1);  // exact only for epsilon = 0
  EXPECT_TRUE(std::isfinite(radial_distance(box, box.pose.translation())));
}

// reach() has a closed form; the mesh's farthest vertex is its brute-force oracle (never beyond, and near it).
TEST(Superquadric, ReachIsTheFarthestPointOfTheBody) {
  Random random(13);
  for (int trial = 0; trial < 200; ++trial) {
    const Superquadric s = random_superquadric(random);
    const Vector3d direction = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    double farthest = 0;
    for (const auto& v : superquadric_vertices(s)) farthest = std::max(farthest, direction.dot(v - s.pose.translation()));
    const double expected = reach(s, direction);
    EXPECT_LE(farthest, expected * (1 + 1e-9)) << trial;
    EXPECT_GE(farthest, expected * 0.95) << trial;  // the sampling misses rounded tips by a little
  }
}

TEST(SuperquadricMesh, IsClosedOrientedAndFreeOfSelfIntersectionsFor500Shapes) {
  Random random(14);
  for (int trial = 0; trial < 500; ++trial) {
    const Superquadric s = random_superquadric(random);
    const TriangleMesh mesh{superquadric_vertices(s), superquadric_topology()->triangles};
    if (trial == 0) {
      const MeshTopology topology = examine_topology(mesh);
      EXPECT_TRUE(topology.closed);
      EXPECT_EQ(topology.euler_characteristic, 2);
      EXPECT_EQ(topology.components, 1);
    }
    for (const auto& v : mesh.vertices) ASSERT_NEAR(gauge(s, v), 1, 1e-9) << trial;
    ASSERT_EQ(count_self_intersections(mesh, 1), 0) << trial << ": " << s.half_axes_m.transpose() << ' ' << s.epsilon1 << ' ' << s.epsilon2;
    const double exact = volume(s), meshed = signed_volume(mesh);
    EXPECT_LE(meshed, exact * (1 + 1e-3)) << trial;  // inscribed in a convex body; a closed form of lgamma
    EXPECT_GE(meshed, exact * 0.93) << trial << ": " << s.half_axes_m.transpose() << ' ' << s.epsilon1 << ' ' << s.epsilon2;
  }
}

TEST(SuperquadricMesh, HasDistinctVerticesThatMoveWithThePose) {
  Random random(15);
  Superquadric s = random_superquadric(random);
  s.pose = Transform::Identity();
  const auto at_rest = superquadric_vertices(s);
  std::set<std::array<double, 3>> distinct;
  for (const auto& v : at_rest) distinct.insert({v.x(), v.y(), v.z()});
  EXPECT_EQ(distinct.size(), at_rest.size());
  s.pose = random_pose(random);
  const auto moved = superquadric_vertices(s);
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_TRUE(moved[i].isApprox(s.pose * at_rest[i], 1e-12));
}

TEST(SuperquadricMesh, SharesOneTopology) {
  EXPECT_EQ(superquadric_topology(), superquadric_topology());
  EXPECT_EQ(superquadric_topology()->types.size(), 610u);
  EXPECT_NE(superquadric_topology()->hash, 0u);
}

}  // namespace
}  // namespace gfp
