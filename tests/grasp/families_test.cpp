// Grasps of parametric household things, planned on the true mesh: the judge must agree.
#include <gtest/gtest.h>

#include "gfp/grasp/judge_grasp.hpp"
#include "gfp/primitive/families.hpp"
#include "grasp/shapes.hpp"

namespace gfp {
namespace {

TEST(PlanGrasps, SucceedsOnFamilyMembers) {
  int objects = 0, held = 0, grasps = 0, successes = 0;
  for (const std::string& name : family_names())
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      Random random(seed);
      const FittedModel model = test::fit_of(sample_family(name, random).mesh);
      const GraspPlan plan = plan_grasps(model, test::table_scene());
      EXPECT_EQ(plan.grasps.empty(), !plan.no_grasp_reason.empty()) << name;
      ++objects;
      held += plan.grasps.empty() ? 0 : 1;
      for (const Grasp& grasp : plan.grasps) {
        ++grasps;
        successes += judge_grasp(model.mesh_camera(), grasp, test::table_scene(), Gripper{}).success ? 1 : 0;
      }
    }
  EXPECT_GE(successes, 0.95 * grasps) << successes << " of " << grasps;
  EXPECT_GE(held, 0.6 * objects) << held << " of " << objects << ": plates and boxes may be too wide for 85 mm";
}

}  // namespace
}  // namespace gfp
