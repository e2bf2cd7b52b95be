#include "support/view_of_mesh.hpp"

#include <gtest/gtest.h>

#include "support/shapes.hpp"

namespace gfp {
namespace {

const CameraModel kCamera = default_kinect_camera();

// Every object point must lie on the box, every support point on the table: the transforms of the view meet.
TEST(ViewOfMesh, PutsPointsOnTheBoxAndOnTheTable) {
  const Eigen::Vector3d size(0.1, 0.06, 0.2);
  const ObjectView view = test::view_of(test::box(size), kCamera, test::look_at({0, 0, 0.1}, 0.8, 0.6, 0.4));
  ASSERT_GT(view.object_pixels, 5000);
  const Transform T_support_camera = view.T_camera_support.inverse();
  for (int j = 0; j < view.tile.height(); ++j)
    for (int i = 0; i < view.tile.width(); ++i) {
      const Eigen::Vector3d p =
          T_support_camera * (kCamera.ray(view.tile.u0 + i, view.tile.v0 + j) * static_cast<double>(view.depth_m.at(i, j)));
      if (view.evidence.at(i, j) == Evidence::kSupport) {
        ASSERT_NEAR(p.z(), 0, 1e-6);
      }
      if (view.evidence.at(i, j) != Evidence::kObject) continue;
      const Eigen::Vector3d outside = (p - Eigen::Vector3d(0, 0, 0.1)).cwiseAbs() - 0.5 * size;
      ASSERT_NEAR(outside.maxCoeff(), 0, 1e-6);
      ASSERT_LT((T_support_camera.linear() * view.normals.at(i, j).cast<double>()).z(), 1.0 + 1e-6);
      ASSERT_LT(view.normals.at(i, j).dot(kCamera.ray(view.tile.u0 + i, view.tile.v0 + j).cast<float>()), 0);
    }
  EXPECT_NEAR(view.height_m, 0.2, 1e-6);
  EXPECT_FALSE(view.occluded);
  EXPECT_FALSE(view.touches_border);
}

TEST(ViewOfMesh, ANearerNeighbourOccludes) {
  const Transform T_world_camera = test::look_at({0, 0, 0.1}, 0.8, 0.4, 0.0);
  const TriangleMesh box = test::box({0.1, 0.1, 0.2});
  const auto beside = transformed(box, Transform(Eigen::Translation3d(0.15, 0.06, -0.05)));
  const ObjectView view = test::view_of(box, kCamera, T_world_camera, {.others_world = {beside}});
  EXPECT_TRUE(view.occluded);
  EXPECT_LT(view.object_pixels, test::view_of(box, kCamera, T_world_camera).object_pixels);
  ASSERT_EQ(view.neighbour_footprints.size(), 1u);
  EXPECT_EQ(view.neighbour_footprints[0].size(), 4u);
}

}  // namespace
}  // namespace gfp
