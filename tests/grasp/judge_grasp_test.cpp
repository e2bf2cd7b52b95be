#include "gfp/grasp/judge_grasp.hpp"

#include <gtest/gtest.h>

#include "grasp/shapes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

/// Straight down onto the middle of what stands on the table, jaw open to 80 mm, tips at `height_m`.
Grasp from_above(double height_m) {
  Grasp grasp;
  Transform T_support_tcp = Transform::Identity();
  T_support_tcp.linear().col(0) = -Vector3d::UnitZ();
  T_support_tcp.linear().col(1) = Vector3d::UnitY();
  T_support_tcp.linear().col(2) = Vector3d::UnitX();
  T_support_tcp.translation() = Vector3d(0, 0, height_m);
  grasp.T_camera_tcp = test::camera_from_support() * T_support_tcp;
  grasp.T_camera_pregrasp_tcp = grasp.T_camera_tcp * Eigen::Translation3d(-0.1, 0, 0);
  grasp.opening_m = 0.08;
  return grasp;
}

GraspVerdict judge(const TriangleMesh& mesh_object, const Grasp& grasp, double friction = 0.5) {
  Gripper gripper;
  gripper.friction = friction;
  return judge_grasp(transformed(mesh_object, test::camera_from_support()), grasp, test::table_scene(), gripper);
}

TEST(JudgeGrasp, ClosesOnTheTrueFaces) {
  const GraspVerdict verdict = judge(test::box_mesh({0.06, 0.05, 0.06}), from_above(0.03));
  EXPECT_TRUE(verdict.success) << verdict.reason;
  EXPECT_NEAR(verdict.width_m, 0.05, 1e-3) << "less what the pads give";
  EXPECT_GT(verdict.epsilon, 0.03);
  EXPECT_TRUE(verdict.reason.empty());
}

TEST(JudgeGrasp, RefusesFingersInsideTheObject) { EXPECT_EQ(judge(test::box_mesh({0.06, 0.09, 0.06}), from_above(0.03)).reason, "collision_object"); }

TEST(JudgeGrasp, RefusesAPalmOnTheObject) { EXPECT_EQ(judge(test::box_mesh({0.06, 0.05, 0.10}), from_above(0.03)).reason, "collision_object"); }

TEST(JudgeGrasp, RefusesTipsInTheTable) { EXPECT_EQ(judge(test::box_mesh({0.06, 0.05, 0.03}), from_above(-0.002)).reason, "collision_scene"); }

TEST(JudgeGrasp, FindsNothingAboveALowBox) { EXPECT_EQ(judge(test::box_mesh({0.06, 0.05, 0.03}), from_above(0.05)).reason, "no_contact"); }

// The flanks of a cone of 45 degrees leave no line inside both friction cones of 27 degrees.
TEST(JudgeGrasp, LetsAConeSlip) { EXPECT_EQ(judge(test::cone_mesh(0.035, 0.035), from_above(0.01)).reason, "not_force_closure"); }

}  // namespace
}  // namespace gfp
