#include "gfp/core/raster.hpp"

#include <gtest/gtest.h>

#include "support/shapes.hpp"

namespace gfp {
namespace {

const CameraModel kCamera = default_kinect_camera();

// Depth at every pixel of a sphere must be where the pixel's ray meets the sphere, up to the faceting.
TEST(Rasterise, PutsASphereWhereItsRaysMeetIt) {
  const double radius = 0.1, distance = 0.8;
  const TriangleMesh mesh = transformed(test::sphere(radius, 128, 64), Transform(Eigen::Translation3d(0, 0, distance)));
  DepthTile tile;
  tile.reset({0, 0, kCamera.width, kCamera.height}, 2);
  rasterise(mesh.vertices, mesh.triangles, kCamera, tile);
  int hits = 0;
  for (int j = 0; j < tile.height; ++j)
    for (int i = 0; i < tile.width; ++i) {
      const Eigen::Vector3d ray = kCamera.ray(2 * i, 2 * j).normalized();
      const double along = ray.z() * distance;
      const double discriminant = along * along - distance * distance + radius * radius;
      const int cell = j * tile.width + i;
      if (discriminant < -1e-4) {
        EXPECT_FALSE(tile.hit(cell));
      }
      if (discriminant < 1e-4) continue;  // the faceted rim
      ASSERT_TRUE(tile.hit(cell)) << i << ' ' << j;
      EXPECT_NEAR(tile.depth[static_cast<std::size_t>(cell)], (along - std::sqrt(discriminant)) * ray.z(), 1.5e-3);
      ++hits;
    }
  EXPECT_GT(hits, 3000);
}

TEST(Rasterise, CullingChangesNothingForAClosedMesh) {
  const TriangleMesh mesh = transformed(test::torus(0.1, 0.03), Transform(Eigen::Translation3d(0.02, -0.05, 0.7)) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
  DepthTile both, front;
  both.reset({200, 150, 440, 330}, 1);
  front.reset({200, 150, 440, 330}, 1);
  rasterise(mesh.vertices, mesh.triangles, kCamera, both);
  rasterise(mesh.vertices, mesh.triangles, kCamera, front, {.cull_back = true});
  EXPECT_EQ(both.depth, front.depth);
}

TEST(Rasterise, LeavesNoCracksBetweenTriangles) {
  // A slanted square of many triangles, larger than the tile: each cell must be hit.
  TriangleMesh mesh;
  constexpr int kSide = 40;
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) mesh.vertices.emplace_back(0.05 * (i - 20), 0.05 * (j - 20), 1.0 + 0.01 * i);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int a = j * (kSide + 1) + i;
      mesh.triangles.push_back({a, a + kSide + 1, a + 1});
      mesh.triangles.push_back({a + 1, a + kSide + 1, a + kSide + 2});
    }
  DepthTile tile;
  tile.reset({100, 100, 500, 400}, 1);
  rasterise(mesh.vertices, mesh.triangles, kCamera, tile);
  for (int cell = 0; cell < tile.width * tile.height; ++cell) ASSERT_TRUE(tile.hit(cell)) << cell;
}

TEST(Barycentric, FindsTheHitPoint) {
  const Eigen::Vector3d a(0, 0, 1), b(0.2, 0, 1.1), c(0, 0.2, 1.3);
  const Eigen::Vector3d weights(0.2, 0.5, 0.3);
  const Eigen::Vector3d point = weights[0] * a + weights[1] * b + weights[2] * c;
  EXPECT_TRUE(barycentric_on_ray(a, b, c, point / point.z()).isApprox(weights, 1e-12));
}

}  // namespace
}  // namespace gfp
