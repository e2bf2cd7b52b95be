#include <gtest/gtest.h>

#include "gfp/grasp/grasp.hpp"

namespace gfp {
namespace {


TEST(MovedPlan, KeepsEveryRelationToTheObject) {
  Grasp grasp;
  grasp.T_camera_tcp = Eigen::Translation3d(0.1, 0.2, 0.7) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized());
  grasp.T_camera_pregrasp_tcp = grasp.T_camera_tcp * Eigen::Translation3d(-0.1, 0, 0);
  grasp.T_camera_parent = grasp.T_camera_tcp * Eigen::Translation3d(-0.15, 0, 0);
  grasp.approach = grasp.T_camera_tcp.linear().col(0);
  grasp.contacts[0] = {grasp.T_camera_tcp * Eigen::Vector3d(0, 0.03, 0), -grasp.T_camera_tcp.linear().col(1), true};
  grasp.width_m = 0.06;
  grasp.epsilon = 0.1;
  const Transform T = Eigen::Translation3d(-0.3, 0.1, 0.2) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(3, -1, 2).normalized());
  const Grasp now = moved({{grasp}, "", 5}, T).grasps.front();
  EXPECT_TRUE(now.T_camera_tcp.isApprox(T * grasp.T_camera_tcp, 1e-12));
  EXPECT_TRUE((now.T_camera_tcp.inverse() * now.T_camera_pregrasp_tcp).isApprox(grasp.T_camera_tcp.inverse() * grasp.T_camera_pregrasp_tcp, 1e-12));
  EXPECT_TRUE((now.T_camera_tcp.inverse() * now.T_camera_parent).isApprox(grasp.T_camera_tcp.inverse() * grasp.T_camera_parent, 1e-12));
  EXPECT_TRUE(now.approach.isApprox(now.T_camera_tcp.linear().col(0), 1e-12));
  EXPECT_TRUE((now.T_camera_tcp.inverse() * now.contacts[0].point).isApprox(Eigen::Vector3d(0, 0.03, 0), 1e-12));
  EXPECT_TRUE(now.contacts[0].normal.isApprox(-now.T_camera_tcp.linear().col(1), 1e-12));
  EXPECT_EQ(now.epsilon, grasp.epsilon);
  EXPECT_EQ(now.width_m, grasp.width_m);
}

TEST(MovedPlan, KeepsTheReasonWhereThereIsNoGrasp) { EXPECT_EQ(moved({{}, "too_wide", 7}, Transform::Identity()).no_grasp_reason, "too_wide"); }

}  // namespace
}  // namespace gfp
