#include "gfp/registration/follow_shape.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/simple_primitives.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

ObjectView view_of_world(const TriangleMesh& mesh_world, double noise_scale, std::uint64_t seed) {
  return test::view_of(mesh_world, default_kinect_camera(), test::look_at({0, 0, 0.05}, 0.8, 35 * kDegree, 15 * kDegree), {.noise_scale = noise_scale, .seed = seed});
}

/// Farthest vertex of the followed body from where it truly is, camera frame.
double farthest_m(const TriangleMesh& mesh, const ObjectView& view, const Transform& T_world_object, const FollowedPose& followed) {
  double farthest = 0;
  for (const Vector3d& p : mesh.vertices)
    farthest = std::max(farthest, (view.T_camera_support.inverse() * followed.T_camera_object * p - T_world_object * p).norm());
  return farthest;
}

FollowedPose follow(const TriangleMesh& mesh, const ObjectView& view, const Transform& T_support_guess) {
  auto topology = std::make_shared<Topology>();
  topology->triangles = mesh.triangles;
  return follow_shape(view, mesh.vertices, topology, view.T_camera_support * T_support_guess);
}

Transform placed(double x, double y, double yaw_deg) {
  return Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(yaw_deg * kDegree, Vector3d::UnitZ());
}

TEST(FollowShape, FindsABoxThatWasPushed) {
  const TriangleMesh box = test::box({0.06, 0.12, 0.15});
  for (const auto& [x, y, yaw] : {std::array{0.01, 0.0, 0.0}, std::array{-0.01, 0.01, 3.0}, std::array{0.0, -0.015, -5.0}}) {
    const Transform truth = placed(x, y, 30 + yaw);
    const ObjectView view = view_of_world(transformed(box, truth), 1, 3);
    EXPECT_LT(farthest_m(box, view, truth, follow(box, view, placed(0, 0, 30))), 0.003) << x << ' ' << y << ' ' << yaw;
  }
}

TEST(FollowShape, LeavesTheYawOfABodyOfRevolutionAlone) {
  const TriangleMesh can = test::cylinder(0.04, 0.12, 64, 4);
  const ObjectView view = view_of_world(transformed(can, placed(0.01, 0, 0)), 1, 3);
  const FollowedPose followed = follow(can, view, placed(0, 0, 0));
  const Eigen::Matrix3d turn = (view.T_camera_support.inverse() * followed.T_camera_object).linear();
  EXPECT_LT(std::abs(std::atan2(turn(1, 0), turn(0, 0))), 3 * kDegree);
  EXPECT_NEAR((view.T_camera_support.inverse() * followed.T_camera_object).translation().x(), 0.01, 0.0015);
}

// Noise is no movement: the pose is the guess to the last bit, whatever the seed.
TEST(FollowShape, LeavesWhatStandsWhereItStands) {
  const TriangleMesh box = test::box({0.06, 0.12, 0.15});
  const Transform truth = placed(0, 0, 30);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const ObjectView view = view_of_world(transformed(box, truth), 1, seed);
    EXPECT_EQ((follow(box, view, truth).T_camera_object.matrix() - (view.T_camera_support * truth).matrix()).cwiseAbs().maxCoeff(), 0.0) << seed;
  }
}

// A creeping body is followed in steps that the view can tell, never farther behind than the noise explains.
TEST(FollowShape, KeepsUpWithWhatCreeps) {
  const TriangleMesh box = test::box({0.06, 0.12, 0.15});
  Transform known = placed(0, 0, 30);
  for (int frame = 1; frame <= 30; ++frame) {
    const Transform truth = placed(0.0005 * frame, -0.0003 * frame, 30 + 0.2 * frame);
    const ObjectView view = view_of_world(transformed(box, truth), 1, static_cast<std::uint64_t>(frame));
    const FollowedPose followed = follow(box, view, known);
    EXPECT_LT(farthest_m(box, view, truth, followed), 0.005) << frame;
    known = view.T_camera_support.inverse() * followed.T_camera_object;
  }
}

TEST(FollowShape, SaysWhatTheViewLeavesOpen) {
  const TriangleMesh can = test::cylinder(0.04, 0.12, 64, 4);
  const FollowedPose followed = follow(can, view_of_world(can, 1, 3), placed(0, 0, 0));
  EXPECT_GT(followed.covariance(5, 5), 30 * followed.covariance(3, 3)) << "yaw means nothing, tilt does";
  EXPECT_LT(std::sqrt(followed.covariance(2, 2)), 0.002) << "it stands on the table";
}

TEST(FollowShape, HasAnAnswerForHardlyAnyData) {
  const TriangleMesh can = test::cylinder(0.04, 0.12);
  ObjectView view = view_of_world(can, 1, 3);
  std::fill(view.evidence.pixels.begin(), view.evidence.pixels.end(), Evidence::kUnknown);
  view.object_pixels = 0;
  EXPECT_TRUE(follow(can, view, placed(0, 0, 0)).T_camera_object.matrix().allFinite());
}

}  // namespace
}  // namespace gfp
