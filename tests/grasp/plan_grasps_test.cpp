#include "gfp/grasp/plan_grasps.hpp"

#include <gtest/gtest.h>

#include "gfp/grasp/judge_grasp.hpp"
#include "grasp/shapes.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

struct NamedMesh {
  const char* name;
  TriangleMesh mesh;
};

std::vector<NamedMesh> graspable_shapes() {
  return {{"box", test::box_mesh({0.06, 0.09, 0.05})},       {"tall box", test::box_mesh({0.05, 0.05, 0.18})},
          {"can", test::cylinder_mesh(0.033, 0.12)},          {"ball", test::sphere_mesh(0.035)},
          {"cup", test::cup_mesh(0.042, 0.09, 0.003)},        {"bowl-wide cup", test::cup_mesh(0.075, 0.06, 0.004)},
          {"ring", test::ring_mesh(0.04, 0.006)}};
}

TEST(PlanGrasps, TestShapesAreClosedAndOutward) {
  for (const auto& [name, mesh] : graspable_shapes()) {
    EXPECT_TRUE(examine_topology(mesh).closed) << name;
    EXPECT_GT(signed_volume(mesh), 0) << name;
  }
}

TEST(PlanGrasps, SucceedsByTheJudgeOnTheTrueMesh) {
  for (const auto& [name, mesh] : graspable_shapes()) {
    const FittedModel model = test::fit_of(mesh);
    const GraspPlan plan = plan_grasps(model, test::table_scene());
    ASSERT_FALSE(plan.grasps.empty()) << name << ": " << plan.no_grasp_reason;
    for (const Grasp& grasp : plan.grasps) {
      const GraspVerdict verdict = judge_grasp(model.mesh_camera(), grasp, test::table_scene(), Gripper{});
      EXPECT_TRUE(verdict.success) << name << ": " << verdict.reason;
      EXPECT_NEAR(verdict.epsilon, grasp.epsilon, 1e-9) << name;
    }
  }
}

}  // namespace
}  // namespace gfp
