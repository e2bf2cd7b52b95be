#include "simulation/settle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gfp/core/random.hpp"
#include "gfp/core/transform.hpp"
#include "simulation/footprint.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

Matrix3d random_rotation(Random& random) {
  return rotation_from_vector(Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)));
}

double height_of_centre(const TriangleMesh& mesh, const Vector3d& centre, const Matrix3d& rotation) {
  double lowest = 1e300;
  for (const Vector3d& v : mesh.vertices) lowest = std::min(lowest, (rotation * v).z());
  return (rotation * centre).z() - lowest;
}

// However a box is let go, one of its faces ends up level on the table.
TEST(Settle, ABoxEndsOnAFace) {
  const TriangleMesh box = test::box({0.2, 0.1, 0.05});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const Matrix3d rotation = settle(box.vertices, {0, 0, 0.025}, random_rotation(random));
    EXPECT_NEAR(rotation.row(2).cwiseAbs().maxCoeff(), 1, 1e-9) << seed;
    EXPECT_NEAR((rotation * rotation.transpose() - Matrix3d::Identity()).norm(), 0, 1e-12) << seed;
  }
}

TEST(Settle, WhatStandsStays) {
  const TriangleMesh can = test::cylinder(0.03, 0.1);
  EXPECT_EQ(settle(can.vertices, {0, 0, 0.05}, Matrix3d::Identity()), Matrix3d::Identity());
}

// 30 degrees tilt a 60 x 100 mm can by less than its tipping angle (31 degrees): it rights itself. 40 degrees: it falls.
TEST(Settle, ACanRightsItselfBelowItsTippingAngleAndFallsBeyondIt) {
  const TriangleMesh can = test::cylinder(0.03, 0.1);
  const auto end = [&](double degrees) { return settle(can.vertices, {0, 0, 0.05}, rotation_from_vector({degrees * std::numbers::pi / 180, 0, 0}))(2, 2); };
  EXPECT_NEAR(end(30), 1, 1e-9);
  EXPECT_NEAR(end(40), 0, 1e-9);
}

TEST(Settle, NeverRaisesTheCentreOfMassAndEndsAboveItsSupport) {
  const TriangleMesh bottle = test::revolve({{0.03, 0}, {0.035, 0.1}, {0.012, 0.15}, {0.012, 0.2}}, 24);
  const Vector3d centre = volume_centroid(bottle);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const Matrix3d start = random_rotation(random), end = settle(bottle.vertices, centre, start);
    EXPECT_LE(height_of_centre(bottle, centre, end), height_of_centre(bottle, centre, start) + 1e-9) << seed;
    const double lowest = (end * centre).z() - height_of_centre(bottle, centre, end);
    std::vector<Eigen::Vector2d> contacts;
    for (const Vector3d& v : bottle.vertices)
      if ((end * v).z() < lowest + 1e-6) contacts.emplace_back((end * v).head<2>());
    EXPECT_GE(contacts.size(), 3U) << seed;
    const Eigen::Vector2d below = (end * centre).head<2>();
    EXPECT_NEAR((nearest_point(convex_hull(contacts), below) - below).norm(), 0, 1e-5) << seed;
  }
}

}  // namespace
}  // namespace gfp
