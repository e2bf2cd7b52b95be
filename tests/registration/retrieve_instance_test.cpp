#include "gfp/registration/retrieve_instance.hpp"

#include <gtest/gtest.h>

#include "support/simple_primitives.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

ObjectView view_of_member(const PrimitivePtr& primitive, const Eigen::Vector3d& size_m, double yaw) {
  const TriangleMesh mesh{shape(*primitive, size_m), primitive->topology->triangles};
  const Transform T_world_object = Transform(Eigen::Translation3d(0.02, -0.01, 0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return test::view_of(transformed(mesh, T_world_object), default_kinect_camera(), test::look_at({0, 0, 0.05}, 0.8, 0.6, 0.4));
}

// The class's mean is among the members: seen exactly, it or one that explains the seen side as well is found and set in place. (Which of
// several boxes stands there, one side does not tell.)
TEST(RetrieveInstance, FindsAMemberThatExplainsTheSeenSide) {
  const auto primitive = test::box_primitive();
  const ObjectView view = view_of_member(primitive, primitive->typical_size_m(), 0.35);
  const Placement placement = retrieve_instance(view, {{primitive, 0, {0}}});
  ASSERT_EQ(placement.primitive, primitive);
  EXPECT_LT(std::sqrt(placement.cost), 0.010);  // half the spacing of the vertices that ICP measures to
  const Eigen::Vector3d base = view.T_camera_support.inverse() * placement.T_camera_object.translation();
  EXPECT_NEAR((base - Eigen::Vector3d(0.02, -0.01, 0)).norm(), 0, 0.030);
}

// Among two classes, the one that looks like it.
TEST(RetrieveInstance, ChoosesAmongClasses) {
  const auto box = test::box_primitive(), can = test::can_primitive();
  const ObjectView view = view_of_member(can, can->typical_size_m(), 0);
  EXPECT_EQ(retrieve_instance(view, {{box, 0, {0}}, {can, 0, {0}}}).primitive, can);
}

TEST(RetrieveInstance, IsDeterministicAndAnswersNothingWithNothing) {
  const auto primitive = test::box_primitive();
  ObjectView view = view_of_member(primitive, {0.08, 0.1, 0.09}, 0);
  const Hypothesis hypothesis{primitive, 0, {0}};
  EXPECT_EQ(retrieve_instance(view, {hypothesis}).T_camera_object.matrix(), retrieve_instance(view, {hypothesis}).T_camera_object.matrix());
  EXPECT_FALSE(retrieve_instance(view, {}).primitive);
  view.depth_m.pixels.assign(view.depth_m.pixels.size(), 0.0F);
  EXPECT_FALSE(retrieve_instance(view, {hypothesis}).primitive);
}

}  // namespace
}  // namespace gfp
