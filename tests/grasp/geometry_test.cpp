// Boxes, hierarchy and the closing jaw against brute force and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gfp/core/random.hpp"
#include "grasp/box.hpp"
#include "grasp/close_jaw.hpp"
#include "grasp/gripper_boxes.hpp"
#include "grasp/shapes.hpp"
#include "grasp/triangle_bvh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

Vector3d random_point(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

Transform random_pose(Random& random, double reach) {
  Transform pose = Transform::Identity();
  pose.linear() = rotation_from_vector(random_point(random, 2.0));
  pose.translation() = random_point(random, reach);
  return pose;
}

double outside(const Vector3d& p, const Vector3d& half) { return (p.cwiseAbs() - half).cwiseMax(0.0).norm(); }

/// Minimum of a convex function on [low, high] by ternary search.
template <class Function>
double convex_minimum(double low, double high, const Function& f) {
  for (int i = 0; i < 90; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  return f(0.5 * (low + high));
}

/// Least distance over barycentric coordinates: the distance to a convex box is convex on the triangle.
double searched_distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& half) {
  return convex_minimum(0, 1, [&](double u) {
    return convex_minimum(0, 1 - u, [&](double v) { return outside(a + u * (b - a) + v * (c - a), half); });
  });
}

TEST(TriangleBoxDistance, EqualsTheMinimumOverTheTriangle) {
  int touching = 0;
  for (int seed = 0; seed < 300; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const Vector3d half(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
    const Vector3d offset = random_point(random, 1.5);
    const Vector3d a = offset + random_point(random, 1), b = offset + random_point(random, 1), c = offset + random_point(random, 1);
    const double distance = triangle_box_distance(a, b, c, half), expected = searched_distance(a, b, c, half);
    EXPECT_NEAR(distance, expected, 1e-6) << "seed " << seed;
    EXPECT_EQ(triangle_meets_box(a, b, c, half), distance == 0) << "seed " << seed;
    touching += distance == 0;
  }
  EXPECT_GT(touching, 50);
  EXPECT_LT(touching, 250);
}

TEST(TriangleBvh, AnswersLikeALoopOverAllTriangles) {
  const TriangleMesh mesh = test::cup_mesh(0.05, 0.1, 0.004);
  const TriangleBvh bvh(mesh.vertices, mesh.triangles);
  for (int seed = 0; seed < 200; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    OrientedBox box{random_pose(random, 0.15), Vector3d(random.uniform(0.002, 0.05), random.uniform(0.002, 0.05), random.uniform(0.002, 0.05))};
    double nearest = 0.3;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto at = [&](std::int32_t i) { return box.T_box_world * mesh.vertices[static_cast<std::size_t>(i)]; };
      nearest = std::min(nearest, triangle_box_distance(at(a), at(b), at(c), box.half));
    }
    EXPECT_NEAR(bvh.distance(box, 0.3), nearest, 1e-12) << "seed " << seed;
    EXPECT_EQ(bvh.meets(box), nearest == 0) << "seed " << seed;
    std::vector<std::int32_t> near;
    bvh.gather(box, near);
    EXPECT_TRUE(nearest > 0 || !near.empty()) << "seed " << seed;
  }
}

// Through a cup's two walls along a level line above its floor: in, out, in, out, at |x| = sqrt(r^2 - y^2) of the polygon.
TEST(TriangleBvh, CrossesBothWallsOfACup) {
  const TriangleMesh mesh = test::cup_mesh(0.05, 0.1, 0.004);
  const TriangleBvh bvh(mesh.vertices, mesh.triangles);
  std::vector<Crossing> crossings;
  bvh.crossings({-0.2, 0, 0.0503}, {1, 0, 0}, 1.0, crossings);
  // The line meets edges between segments, where both neighbours may report: look at the distances only.
  ASSERT_GE(crossings.size(), 4U);
  EXPECT_NEAR(crossings.front().distance_m, 0.15, 1e-9);
  EXPECT_TRUE(crossings.front().entering);
  EXPECT_NEAR(crossings.back().distance_m, 0.25, 1e-9);
  EXPECT_FALSE(crossings.back().entering);
  EXPECT_TRUE(std::any_of(crossings.begin(), crossings.end(), [](const Crossing& c) { return !c.entering && std::abs(c.distance_m - 0.154) < 1e-9; }));
  bvh.crossings({-0.2, 0, 0.0503}, {1, 0, 0}, 0.1, crossings);
  EXPECT_TRUE(crossings.empty()) << "beyond the limit";
  bvh.crossings({-0.2, 0, 0.0503}, {0, 0, 1}, 1.0, crossings);
  EXPECT_TRUE(crossings.empty()) << "beside the cup";
}

TEST(TriangleBvh, OfNothingMeetsNothing) {
  const TriangleBvh bvh({}, {});
  std::vector<Crossing> crossings;
  bvh.crossings(Vector3d::Zero(), Vector3d::UnitX(), 1, crossings);
  EXPECT_TRUE(crossings.empty());
  EXPECT_FALSE(bvh.meets({Transform::Identity(), Vector3d::Ones()}));
  EXPECT_EQ(bvh.distance({Transform::Identity(), Vector3d::Ones()}, 0.5), 0.5);
}

// The docstring of Gripper, in numbers: tips at the origin, fingers and palm behind it, pads at half the opening.
TEST(GripperBoxes, StandWhereTheGripperSays) {
  const Gripper gripper;
  const GripperBoxes boxes = gripper_boxes(gripper, Transform::Identity(), 0.06, 0.1);
  const auto inside = [](const OrientedBox& box, const Vector3d& p) { return point_box_distance(p, box) == 0; };
  EXPECT_TRUE(inside(boxes.fingers[0], {-0.001, 0.0301, 0}));
  EXPECT_FALSE(inside(boxes.fingers[0], {-0.001, 0.0299, 0})) << "the gap is free";
  EXPECT_FALSE(inside(boxes.fingers[0], {0.001, 0.035, 0})) << "nothing is before the tips";
  EXPECT_TRUE(inside(boxes.fingers[1], {-0.001, -0.0301, 0}));
  EXPECT_TRUE(inside(boxes.fingers[0], {-0.14, 0.035, 0.0099})) << "swept back by 0.1";
  EXPECT_FALSE(inside(boxes.fingers[0], {-0.146, 0.035, 0}));
  EXPECT_TRUE(inside(boxes.palm, {-0.0451, 0.069, 0.034}));
  EXPECT_FALSE(inside(boxes.palm, {-0.0449, 0, 0}));
  EXPECT_TRUE(inside(boxes.closing, {-0.02, 0, 0}));
}

// A box between the pads: both touch a face head-on, at the middle of pad and face.
TEST(CloseJaw, TouchesTheFacesOfABox) {
  TriangleMesh mesh = test::box_mesh({0.2, 0.05, 0.2});
  const TriangleBvh bvh(mesh.vertices, mesh.triangles);
  Transform T_world_tcp = Transform::Identity();
  T_world_tcp.translation() = Vector3d(0, 0.004, 0.1);  // off the box's middle
  const auto touches = close_jaw(mesh, bvh, Gripper{}, T_world_tcp, 0.08);
  ASSERT_TRUE(touches);
  EXPECT_TRUE((*touches)[0].point.isApprox(Vector3d(-0.0225, 0.021, 0), 1e-9)) << (*touches)[0].point.transpose();
  EXPECT_TRUE((*touches)[1].point.isApprox(Vector3d(-0.0225, -0.029, 0), 1e-9));
  EXPECT_TRUE((*touches)[0].normal.isApprox(Vector3d(0, -1, 0), 1e-9));
  EXPECT_TRUE((*touches)[1].normal.isApprox(Vector3d(0, 1, 0), 1e-9));
}

// A cylinder lying across the pads touches along its crest.
TEST(CloseJaw, TouchesTheCrestOfACylinder) {
  const TriangleMesh mesh = test::cylinder_mesh(0.03, 0.1, 256);
  const TriangleBvh bvh(mesh.vertices, mesh.triangles);
  Transform T_world_tcp = Transform::Identity();
  T_world_tcp.translation() = Vector3d(0.02, 0, 0.05);  // 0.0225 before the pads' middle: the crest is inside the pad
  const auto touches = close_jaw(mesh, bvh, Gripper{}, T_world_tcp, 0.07);
  ASSERT_TRUE(touches);
  EXPECT_NEAR((*touches)[0].point.x(), -0.02, 5e-4);
  EXPECT_NEAR((*touches)[0].point.y(), 0.03, kPadGive);
  EXPECT_GT((*touches)[1].normal.y(), 0.999);
}

TEST(CloseJaw, FindsNothingInAnEmptyGap) {
  const TriangleMesh mesh = test::box_mesh({0.02, 0.02, 0.02});
  const TriangleBvh bvh(mesh.vertices, mesh.triangles);
  Transform T_world_tcp = Transform::Identity();
  T_world_tcp.translation() = Vector3d(0, 0, 0.5);
  EXPECT_FALSE(close_jaw(mesh, bvh, Gripper{}, T_world_tcp, 0.08));
}

}  // namespace
}  // namespace gfp
