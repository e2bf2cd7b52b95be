#include "gfp/grasp/plan_grasps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gfp/core/random.hpp"
#include "gfp/grasp/clear_of_points.hpp"
#include "gfp/grasp/judge_grasp.hpp"
#include "grasp/gripper_boxes.hpp"
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

TEST(PlanGrasps, GivesFramesAsTheGripperSays) {
  const FittedModel model = test::fit_of(test::box_mesh({0.06, 0.09, 0.05}));
  Gripper gripper;
  gripper.T_tcp_parent.translation() = Vector3d(-0.105, 0, 0);
  for (const Grasp& grasp : plan_grasps(model, test::table_scene(), gripper).grasps) {
    const Eigen::Matrix3d R = grasp.T_camera_tcp.linear();
    EXPECT_NEAR(R.determinant(), 1, 1e-12);
    EXPECT_TRUE(R.col(0).isApprox(grasp.approach, 1e-12)) << "x is the approach";
    const Vector3d first = grasp.T_camera_tcp.inverse() * grasp.contacts[0].point, second = grasp.T_camera_tcp.inverse() * grasp.contacts[1].point;
    EXPECT_NEAR(first.y(), 0.5 * grasp.width_m, 1e-9) << "y is the closing axis, the first contact at +y";
    EXPECT_NEAR(second.y(), -0.5 * grasp.width_m, 1e-9);
    EXPECT_LT(first.x(), 0) << "contacts lie behind the tips";
    EXPECT_LT(R.col(1).dot(grasp.contacts[0].normal), -0.9) << "normals point into the object";
    EXPECT_TRUE((grasp.T_camera_pregrasp_tcp.translation() - grasp.T_camera_tcp.translation()).isApprox(-0.10 * grasp.approach, 1e-9));
    EXPECT_TRUE(grasp.T_camera_parent.isApprox(grasp.T_camera_tcp * gripper.T_tcp_parent));
    EXPECT_LE(grasp.opening_m, gripper.stroke_m);
    EXPECT_GT(grasp.opening_m, grasp.width_m);
    EXPECT_EQ(grasp.visibility, "both");
    EXPECT_TRUE(grasp.force_closure);
    EXPECT_GT(grasp.volume_quality, 0);
    EXPECT_GT(grasp.collision_margin_m, 0);
  }
}

// The list is sorted, and no two of its grasps are the same to a user.
TEST(PlanGrasps, ListsDifferentGraspsBestFirst) {
  for (const auto& [name, mesh] : graspable_shapes()) {
    const auto grasps = plan_grasps(test::fit_of(mesh), test::table_scene()).grasps;
    EXPECT_GE(grasps.size(), 3U) << name;
    EXPECT_LE(grasps.size(), 10U) << name;
    for (std::size_t i = 0; i < grasps.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE(grasps[j].score, grasps[i].score) << name;
        const double apart = (grasps[i].T_camera_tcp.translation() - grasps[j].T_camera_tcp.translation()).norm();
        const bool turned = grasps[i].approach.dot(grasps[j].approach) < 0.907 ||
                            std::abs(grasps[i].T_camera_tcp.linear().col(1).dot(grasps[j].T_camera_tcp.linear().col(1))) < 0.907;
        EXPECT_TRUE(turned || apart > 0.005) << name << ' ' << i << ' ' << j;
      }
  }
}

TEST(PlanGrasps, NeverComesFromBelow) {
  const Vector3d up = test::camera_from_support().linear().col(2);
  for (const auto& [name, mesh] : graspable_shapes())
    for (const Grasp& grasp : plan_grasps(test::fit_of(mesh), test::table_scene()).grasps) EXPECT_LE(grasp.approach.dot(up), 0.051) << name;
}

TEST(PlanGrasps, IsTheSameEveryTime) {
  const FittedModel model = test::fit_of(test::cup_mesh(0.042, 0.09, 0.003), 0.002);
  const auto once = plan_grasps(model, test::table_scene()).grasps, again = plan_grasps(model, test::table_scene()).grasps;
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].T_camera_tcp.matrix(), again[i].T_camera_tcp.matrix());
    EXPECT_EQ(once[i].score, again[i].score);
  }
}

// A cup of 84 mm is too wide for the jaw; its 3 mm wall is not: one finger goes into the cavity.
TEST(PlanGrasps, HoldsAWideCupByItsRim) {
  const FittedModel model = test::fit_of(test::cup_mesh(0.042, 0.09, 0.003));
  const Vector3d up = test::camera_from_support().linear().col(2);
  const auto grasps = plan_grasps(model, test::table_scene()).grasps;
  ASSERT_FALSE(grasps.empty());
  for (const Grasp& grasp : grasps) {
    EXPECT_LT(grasp.width_m, 0.006);
    EXPECT_LT(grasp.approach.dot(up), -0.3) << "into the mouth";
  }
}

// A fit is never quite flat: facets that lean to and fro by some degrees must not make a box or can slip out of long fingers.
TEST(PlanGrasps, HoldsFacetsThatLean) {
  for (TriangleMesh mesh : {test::box_mesh({0.26, 0.052, 0.183}, 12), test::cylinder_mesh(0.035, 0.239, 32, 12)}) {
    Random random(5);
    for (Vector3d& vertex : mesh.vertices)
      if (vertex.z() > 0.001) vertex += 0.0007 * Vector3d(random.normal(), random.normal(), random.normal());
    const FittedModel model = test::fit_of(mesh);
    const GraspPlan plan = plan_grasps(model, test::table_scene());
    ASSERT_FALSE(plan.grasps.empty()) << plan.no_grasp_reason;
    for (const Grasp& grasp : plan.grasps) EXPECT_TRUE(judge_grasp(model.mesh_camera(), grasp, test::table_scene(), Gripper{}).success);
  }
}

// A glass of 60 mm fits into the jaw, and so does its wall: around the body the weight cannot turn it.
TEST(PlanGrasps, PrefersTheBodyToTheRimWhereItFits) {
  const FittedModel model = test::fit_of(test::cup_mesh(0.030, 0.09, 0.003));
  const auto grasps = plan_grasps(model, test::table_scene()).grasps;
  ASSERT_FALSE(grasps.empty());
  EXPECT_GT(grasps.front().width_m, 0.05);
  for (std::size_t i = 1; i < grasps.size(); ++i) EXPECT_FALSE(grasps[i - 1].width_m < 0.01 && grasps[i].width_m > 0.05 && !grasps[i].abstain) << i;
}

// A mug: body too wide, inside closed by a lid; what is left is its handle.
TEST(PlanGrasps, HoldsAWideBodyByItsHandle) {
  TriangleMesh mug = test::cylinder_mesh(0.06, 0.09);
  Transform aside = Transform::Identity();
  aside.translation() = Vector3d(0.085, 0, 0.005);  // a ring of its own in front of the body, not touching it
  append(mug, transformed(test::ring_mesh(0.018, 0.005), aside));
  const FittedModel model = test::fit_of(mug);
  const GraspPlan plan = plan_grasps(model, test::table_scene());
  ASSERT_FALSE(plan.grasps.empty()) << plan.no_grasp_reason;
  for (const Grasp& grasp : plan.grasps) {
    const Vector3d middle = model.T_camera_object.inverse() * (0.5 * (grasp.contacts[0].point + grasp.contacts[1].point));
    EXPECT_GT(middle.x(), 0.06);
    EXPECT_TRUE(judge_grasp(model.mesh_camera(), grasp, test::table_scene(), Gripper{}).success);
  }
}

TEST(PlanGrasps, PrefersThePrimitivesOwnPairsWhereNothingIsSampled) {
  const TriangleMesh mesh = test::box_mesh({0.06, 0.09, 0.05}, 2);
  FittedModel model = test::fit_of(mesh);
  auto primitive = std::make_shared<Primitive>();
  primitive->topology = model.topology;
  const auto normals = triangle_normals(mesh);
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(mesh.triangles.size()); ++f)
    for (std::int32_t g = 0; g < f; ++g)
      if (normals[static_cast<std::size_t>(f)].dot(normals[static_cast<std::size_t>(g)]) < -0.99) {
        const Vector3d middle = Vector3d::Constant(1.0 / 3.0);
        primitive->contact_pairs.push_back({{f, g}, {middle, middle}});
      }
  PlanGraspsOptions options;
  options.samples = 1;
  const auto without = plan_grasps(model, test::table_scene(), {}, options).grasps.size();
  model.primitive = primitive;
  EXPECT_GT(plan_grasps(model, test::table_scene(), {}, options).grasps.size(), without);
}

// ---- scenes -------------------------------------------------------------------------------------------------------

FittedModel moved(FittedModel model, const Vector3d& by_support) {
  model.T_camera_object = model.T_camera_object * Eigen::Translation3d(by_support);
  return model;
}

TEST(PlanGrasps, KeepsItsDistanceFromNeighboursAndSaysHowMuch) {
  const FittedModel can = test::fit_of(test::cylinder_mesh(0.03, 0.1));
  const FittedModel wall = moved(test::fit_of(test::box_mesh({0.3, 0.05, 0.3})), {0, 0.06, 0});  // 5 mm beside the can
  GraspScene scene = test::table_scene();
  scene.neighbours = {&wall};
  const auto grasps = plan_grasps(can, scene).grasps;
  ASSERT_FALSE(grasps.empty());
  for (const Grasp& grasp : grasps) {
    EXPECT_GE(grasp.collision_margin_m, 0.003 - 1e-9);
    EXPECT_TRUE(judge_grasp(can.mesh_camera(), grasp, scene, Gripper{}).success);
    // The same distance from points all over the boxes: to the table z = 0 and to the wall, a box itself.
    const GripperBoxes boxes = gripper_boxes(Gripper{}, grasp.T_camera_tcp, grasp.opening_m, 0.10);
    const Transform T_support_camera = test::camera_from_support().inverse();
    double sampled = 0.2;
    for (const OrientedBox& box : {boxes.closing, boxes.palm})
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j)
          for (int k = 0; k <= 20; ++k) {
            const Vector3d p = T_support_camera * (box.T_box_world.inverse() * Vector3d(box.half.cwiseProduct(Vector3d(i, j, k) * 0.1 - Vector3d::Ones())));
            const Vector3d to_wall = ((p - Vector3d(0, 0.06, 0.15)).cwiseAbs() - Vector3d(0.15, 0.025, 0.15)).cwiseMax(0.0);
            sampled = std::min({sampled, p.z(), to_wall.norm()});
          }
    EXPECT_NEAR(grasp.collision_margin_m, sampled, 0.002) << "points stand at most 12 mm apart";
  }
}

TEST(PlanGrasps, AvoidsObstaclePoints) {
  const FittedModel can = test::fit_of(test::cylinder_mesh(0.03, 0.1));
  GraspScene scene = test::table_scene();
  const auto before = plan_grasps(can, scene).grasps;
  ASSERT_FALSE(before.empty());
  scene.obstacle_points_camera = {(before[0].T_camera_tcp * Vector3d(-0.08, 0, 0)).cast<float>(), Eigen::Vector3f::Constant(NAN)};
  const auto after = plan_grasps(can, scene).grasps;
  ASSERT_FALSE(after.empty());
  for (const Grasp& grasp : after) EXPECT_TRUE(judge_grasp(can.mesh_camera(), grasp, scene, Gripper{}).success);
  EXPECT_EQ(judge_grasp(can.mesh_camera(), before[0], scene, Gripper{}).reason, "collision_scene");
}

TEST(ClearOfPoints, SeesAHandInTheWayButNoStrayPixel) {
  const GraspPlan plan = plan_grasps(test::fit_of(test::cylinder_mesh(0.03, 0.1)), test::table_scene());
  ASSERT_FALSE(plan.grasps.empty());
  const Eigen::Vector3f inside = (plan.grasps.back().T_camera_tcp * Vector3d(-0.08, 0, 0)).cast<float>();  // in the palm of the last grasp
  const Eigen::Vector3f behind = inside + Eigen::Vector3f(0, 0, 1);
  std::vector<Eigen::Vector3f> points{inside, behind, behind, behind, behind};
  EXPECT_TRUE(clear_of_points(plan, points, Gripper{}, PlanGraspsOptions{}));
  points.insert(points.end(), 3, inside);
  EXPECT_FALSE(clear_of_points(plan, points, Gripper{}, PlanGraspsOptions{}));
  EXPECT_TRUE(clear_of_points({}, points, Gripper{}, PlanGraspsOptions{}));
}

TEST(PlanGrasps, WorksWithoutASupport) {
  const FittedModel can = test::fit_of(test::cylinder_mesh(0.03, 0.1));
  const auto grasps = plan_grasps(can, GraspScene{}).grasps;
  ASSERT_FALSE(grasps.empty());
  for (const Grasp& grasp : grasps) EXPECT_GE(grasp.approach.dot(can.T_camera_object.translation()), -0.1) << "not from behind";
}

// ---- every reason code ----------------------------------------------------------------------------------------------

TEST(NoGraspReason, TooWide) { EXPECT_EQ(plan_grasps(test::fit_of(test::box_mesh({0.3, 0.4, 0.3})), test::table_scene()).no_grasp_reason, "too_wide"); }

// Lid and bottom of the low can, 60 mm apart, fit into the jaw but not with the table there: what lacks is stroke.
TEST(NoGraspReason, TooWideThoughSomePairsFit) {
  for (const double height_m : {0.06, 0.12})
    EXPECT_EQ(plan_grasps(test::fit_of(test::cylinder_mesh(0.055, height_m)), test::table_scene()).no_grasp_reason, "too_wide") << height_m;
}

// A cone with 90 degrees at its apex: no two of its sides face each other inside cones of 17 degrees, nor do side and base.
TEST(NoGraspReason, NoAntipodalPair) {
  Gripper gripper;
  gripper.friction = 0.3;
  EXPECT_EQ(plan_grasps(test::fit_of(test::cone_mesh(0.06, 0.06)), test::table_scene(), gripper).no_grasp_reason, "no_antipodal_pair");
  FittedModel nothing = test::fit_of({});
  EXPECT_EQ(plan_grasps(nothing, test::table_scene()).no_grasp_reason, "no_antipodal_pair");
}

TEST(NoGraspReason, AllInCollision) {
  const FittedModel can = test::fit_of(test::cylinder_mesh(0.03, 0.1));
  const FittedModel north = moved(test::fit_of(test::box_mesh({0.4, 0.1, 0.4}, 20)), {0, 0.085, 0}), south = moved(north, {0, -0.17, 0});
  const FittedModel east = moved(test::fit_of(test::box_mesh({0.1, 0.4, 0.4}, 20)), {0.085, 0, 0}), west = moved(east, {-0.17, 0, 0});
  GraspScene scene = test::table_scene();  // a shaft of 70 mm, 300 mm deep: no finger fits in beside the can
  scene.neighbours = {&north, &south, &east, &west};
  EXPECT_EQ(plan_grasps(can, scene).no_grasp_reason, "all_in_collision");
}

// Walls 160 mm around the can and a roof: the gripper (105 mm long) fits in, its 100 mm of straight approach do not.
TEST(NoGraspReason, Unreachable) {
  const FittedModel can = test::fit_of(test::cylinder_mesh(0.03, 0.1));
  const FittedModel north = moved(test::fit_of(test::box_mesh({0.4, 0.02, 0.4}, 20)), {0, 0.16, 0}), south = moved(north, {0, -0.32, 0});
  const FittedModel east = moved(test::fit_of(test::box_mesh({0.02, 0.4, 0.4}, 20)), {0.16, 0, 0}), west = moved(east, {-0.32, 0, 0});
  const FittedModel roof = moved(test::fit_of(test::box_mesh({0.4, 0.4, 0.02}, 20)), {0, 0, 0.24});
  GraspScene scene = test::table_scene();
  scene.neighbours = {&north, &south, &east, &west, &roof};
  EXPECT_EQ(plan_grasps(can, scene).no_grasp_reason, "unreachable");
}

TEST(NoGraspReason, NotForceClosure) {
  PlanGraspsOptions demanding;
  demanding.min_epsilon = 0.5;  // more than the torsional reach of the pads can give
  EXPECT_EQ(plan_grasps(test::fit_of(test::cylinder_mesh(0.03, 0.1)), test::table_scene(), {}, demanding).no_grasp_reason, "not_force_closure");
}

TEST(NoGraspReason, NotPlanned) {
  PlanGraspsOptions none;
  none.max_grasps = 0;
  EXPECT_EQ(plan_grasps(test::fit_of(test::cylinder_mesh(0.03, 0.1)), test::table_scene(), {}, none).no_grasp_reason, "not_planned");
}

// ---- uncertainty ------------------------------------------------------------------------------------------------------

TEST(ShapeUncertainty, LowersTheProbabilityAndTheBound) {
  const TriangleMesh mesh = test::cylinder_mesh(0.03, 0.1, 48);
  double last_p = 1.01, last_bound = 1;
  for (const double sigma_m : {0.0, 0.004, 0.012, 0.030}) {
    const auto grasps = plan_grasps(test::fit_of(mesh, sigma_m), test::table_scene()).grasps;
    ASSERT_FALSE(grasps.empty());
    double p = 0, bound = 0;
    for (const Grasp& grasp : grasps) {
      p += grasp.p_force_closure / static_cast<double>(grasps.size());
      bound += grasp.epsilon_lcb / static_cast<double>(grasps.size());
      EXPECT_LE(grasp.epsilon_lcb, grasp.epsilon * 1.6) << "friction varies by 20 %";
      EXPECT_EQ(grasp.abstain, grasp.p_force_closure < 0.6);
    }
    EXPECT_LE(p, last_p) << sigma_m;
    EXPECT_LE(bound, last_bound) << sigma_m;
    last_p = p;
    last_bound = bound;
  }
  EXPECT_LT(last_p, 0.6) << "3 cm of uncertainty on a can of 6 cm: abstain";
}

// The front was measured to a millimetre; of the back less and less is known.
TEST(ShapeUncertainty, OfAHiddenBackIsSaneAtAnySize) {
  double last_p = 1.01;
  for (const double sigma_m : {0.001, 0.005, 0.015, 0.05, 1.0, 1e30}) {
    FittedModel model = test::fit_of(test::cylinder_mesh(0.033, 0.12, 48), 0.001);
    for (std::size_t v = 0; v < model.vertices.size(); ++v)
      if (model.vertices[v].y() > 0) {
        model.states[v] = 0;
        model.sigma_m[v] = static_cast<float>(sigma_m);
      }
    const auto grasps = plan_grasps(model, test::table_scene()).grasps;
    ASSERT_FALSE(grasps.empty()) << sigma_m;
    double p = 0;
    for (const Grasp& grasp : grasps) {
      EXPECT_GE(grasp.p_force_closure, 0);
      EXPECT_LE(grasp.p_force_closure, 1);
      EXPECT_TRUE(std::isfinite(grasp.epsilon_lcb) && std::isfinite(grasp.score)) << sigma_m;
      p += grasp.p_force_closure / static_cast<double>(grasps.size());
    }
    EXPECT_LE(p, last_p + 0.05) << sigma_m;
    last_p = p;
    if (sigma_m <= 0.005) { EXPECT_FALSE(grasps.front().abstain) << "the jaw opens wider than that"; }
    if (sigma_m >= 0.05) { EXPECT_TRUE(grasps.front().abstain) << sigma_m << " on a can of 66 mm"; }
  }
}

TEST(ShapeUncertainty, OfThePoseCountsToo) {
  FittedModel model = test::fit_of(test::box_mesh({0.06, 0.09, 0.05}));
  const double sure = plan_grasps(model, test::table_scene()).grasps.at(0).p_force_closure;
  model.pose_covariance.diagonal() << 4e-4, 4e-4, 1e-6, 1e-3, 1e-3, 0.25;  // 2 cm and 29 degrees about z
  const double unsure = plan_grasps(model, test::table_scene()).grasps.at(0).p_force_closure;
  EXPECT_EQ(sure, 1);
  EXPECT_LT(unsure, 0.7);
}

TEST(ShapeUncertainty, LabelsWhatWasSeenAndWhereToLook) {
  FittedModel model = test::fit_of(test::box_mesh({0.06, 0.3, 0.05}), 0.001);
  for (std::size_t v = 0; v < model.vertices.size(); ++v)
    if (model.vertices[v].x() < -0.029) model.states[v] = 0;  // one long side was hidden
  bool across = false;
  for (const Grasp& grasp : plan_grasps(model, test::table_scene()).grasps) {
    if (std::abs(grasp.width_m - 0.06) > 1e-3) continue;
    across = true;
    EXPECT_EQ(grasp.visibility, "one");
    EXPECT_GT(grasp.helpful_view.dot(model.T_camera_object.linear() * Vector3d::UnitX()), 0.95) << "onto the hidden side, into the object";
  }
  EXPECT_TRUE(across);
}

}  // namespace
}  // namespace gfp
