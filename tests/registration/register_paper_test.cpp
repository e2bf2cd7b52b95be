#include "gfp/registration/register_paper.hpp"

#include <gtest/gtest.h>

#include "gfp/memory/object_points.hpp"
#include "registration/align_icp.hpp"
#include "registration/nearest_point_field.hpp"
#include "support/simple_primitives.hpp"
#include "support/view_of_mesh.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

/// Mean distance from the object's readings to the placed vertices' nearest triangle centre or vertex: an upper bound of the misfit.
double mean_misfit(const ObjectView& view, const Placement& placement) {
  const auto vertices = shape(*placement.primitive, placement.size_m, placement.modes);
  double sum = 0;
  const auto points = object_points(view);
  for (const auto& p : points) {
    double best = 1e300;
    for (const auto& v : vertices) best = std::min(best, (placement.T_camera_object * v - p.cast<double>()).norm());
    sum += best;
  }
  return sum / static_cast<double>(points.size());
}

/// The box primitive as it is, 90 x 90 x 120 mm, scaled, turned and moved, seen from one side.
ObjectView box_view(const Transform& T_world_box, double scale) {
  const auto primitive = test::box_primitive();
  const TriangleMesh mesh{shape(*primitive, scale * primitive->typical_size_m()), primitive->topology->triangles};
  return test::view_of(transformed(mesh, T_world_box), default_kinect_camera(), test::look_at({0, 0, 0.05}, 0.8, 35 * kDegree, 25 * kDegree));
}

// P16: one view shows half of the object, so its circumscribed sphere and centre of mass are off; what is left after ICP is millimetres.
TEST(RegisterPaper, ComesWithinMillimetresOfOneView) {
  for (const double yaw : {0.0, 0.5, 1.1}) {
    const ObjectView view = box_view(Transform(Eigen::Translation3d(0.02, 0.01, 0) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ())), 1.2);
    const Placement placement = register_paper(view, {test::box_primitive(), 0, {0}});
    EXPECT_NEAR(placement.size_m.x() / 0.09, placement.size_m.z() / 0.12, 1e-9) << "the class's proportions are kept (P11)";
    EXPECT_NEAR(placement.size_m.z(), 1.2 * 0.12, 0.25 * 0.12) << yaw;
    EXPECT_LT(mean_misfit(view, placement), 0.015) << yaw;
    EXPECT_TRUE((placement.T_camera_object.linear().transpose() * placement.T_camera_object.linear()).isIdentity(1e-9));
    EXPECT_NEAR(placement.T_camera_object.linear().determinant(), 1, 1e-9);
  }
}

TEST(RegisterPaper, IsDeterministic) {
  const ObjectView view = box_view(Transform::Identity(), 1.0);
  const Hypothesis hypothesis{test::box_primitive(), 0, {0}};
  EXPECT_EQ(register_paper(view, hypothesis).T_camera_object.matrix(), register_paper(view, hypothesis).T_camera_object.matrix());
}

TEST(RegisterPaper, WithoutPointsStaysWhereItIs) {
  ObjectView view = box_view(Transform::Identity(), 1.0);
  view.depth_m.pixels.assign(view.depth_m.pixels.size(), std::numeric_limits<float>::quiet_NaN());
  const Placement placement = register_paper(view, {test::box_primitive(), 0, {0}});
  EXPECT_FALSE(placement.converged);
  EXPECT_TRUE(placement.T_camera_object.matrix().allFinite());
}

// ICP on a whole surface takes back a small motion.
TEST(AlignIcp, TakesBackASmallMotion) {
  const auto target = shape(*test::box_primitive(), {0.1, 0.1, 0.1});
  const Transform motion = Transform(Eigen::Translation3d(0.004, -0.003, 0.002) * Eigen::AngleAxisd(0.05, Vector3d(1, 2, 3).normalized()));
  std::vector<Vector3d> source;
  for (const auto& p : target) source.push_back(motion * p);
  const IcpResult result = align_icp(source, target, 100);
  EXPECT_TRUE((result.T_target_source * motion).isApprox(Transform::Identity(), 1e-3)) << (result.T_target_source * motion).matrix();
  EXPECT_LT(result.mean_squared_m2, 1e-7);
  EXPECT_FALSE(align_icp({}, target, 10).converged);
  EXPECT_FALSE(align_icp(source, target, 0).converged);
}

// Onto half of what the target has, from 8 degrees and 10 mm away: at least as near as PCL's.
TEST(AlignIcp, ComesAsNearAsPcl) {
  const PrimitivePtr box = test::box_primitive();
  const auto target = shape(*box, {0.1, 0.14, 0.08});
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    const Transform motion = Transform(Eigen::Translation3d(0.006, -0.007, 0.004) * Eigen::AngleAxisd(0.14, Vector3d(1, 2, 3).normalized()));
    std::vector<Vector3d> source;
    while (source.size() < 1500) {
      const auto& t = box->topology->triangles[static_cast<std::size_t>(random.below(static_cast<int>(box->topology->triangles.size())))];
      const double a = random.uniform(), b = random.uniform() * (1 - a);
      const auto at = [&](int k) { return target[static_cast<std::size_t>(t[k])]; };
      const Vector3d p = a * at(0) + b * at(1) + (1 - a - b) * at(2);
      if (p.x() + p.z() > 0.04) source.push_back(motion * (p + 0.001 * Vector3d(random.normal(), random.normal(), random.normal())));
    }
    const IcpResult ours = align_icp(source, target, 200), pcl = align_icp_pcl(source, target, 200);
    EXPECT_TRUE(ours.converged);
    EXPECT_LT(ours.mean_squared_m2, 1.02 * pcl.mean_squared_m2) << "seed " << seed;
    double squared = 0;
    for (const auto& p : source) {
      double least = 1;
      for (const auto& q : target) least = std::min(least, (ours.T_target_source * p - q).squaredNorm());
      squared += least / static_cast<double>(source.size());
    }
    EXPECT_NEAR(ours.mean_squared_m2, squared, 1e-12);  // each point's exact nearest
  }
}

// Within a cell's diagonal of the truth, inside the grid and outside.
TEST(NearestPointField, AgreesWithBruteForce) {
  Random random(4);
  std::vector<Vector3d> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(0.05 * random.normal(), 0.03 * random.normal(), 0.08 * random.normal());
  const NearestPointField field(points, 0.05);
  const double diagonal = std::sqrt(3.0) * (bounds(points).size().maxCoeff() + 0.1) / 40;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d place(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    double best = 1e300;
    for (const auto& p : points) best = std::min(best, (p - place).norm());
    const bool inside = (place.cwiseAbs().array() < 0.1).all();
    ASSERT_GE(field.distance(place), best - 1e-12);
    if (inside) {
      ASSERT_LE(field.distance(place), best + diagonal) << i;
    }
  }
}

}  // namespace
}  // namespace gfp
