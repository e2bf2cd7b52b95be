#include "gfp/core/isosurface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gfp/core/self_intersections.hpp"
#include "gfp/core/simplified.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;

template <class Field>
ScalarGrid sampled(double step_m, Field&& field) {
  const int samples = static_cast<int>(std::ceil(3.0 / step_m)) + 1;
  ScalarGrid grid(Vector3d::Constant(-1.5), step_m, Eigen::Vector3i::Constant(samples));
  for (int k = 0; k < samples; ++k)
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i) grid.values[grid.index(i, j, k)] = static_cast<float>(field(grid.place({i, j, k})));
  return grid;
}

double ball(const Vector3d& p, const Vector3d& centre, double radius) { return radius - (p - centre).norm(); }

TEST(Isosurface, OfABallIsABall) {
  for (const double step : {0.2, 0.1}) {
    const TriangleMesh mesh = isosurface(sampled(step, [](const Vector3d& p) { return ball(p, {0.03, 0.02, 0.01}, 1); }), 0.0F);
    const MeshTopology topology = examine_topology(mesh);
    EXPECT_TRUE(topology.closed);
    EXPECT_EQ(topology.euler_characteristic, 2);
    EXPECT_EQ(count_self_intersections(mesh, 1), 0);
    EXPECT_NEAR(signed_volume(mesh), 4 * std::numbers::pi / 3, 2.5 * step * step);  // a polyhedron inside the ball; positive: outwards
    for (const Vector3d& v : mesh.vertices) ASSERT_NEAR((v - Vector3d(0.03, 0.02, 0.01)).norm(), 1, 0.3 * step);
  }
}

TEST(Isosurface, KeepsTheGenusAndEveryComponent) {
  const TriangleMesh mesh = isosurface(sampled(0.05, [](const Vector3d& p) {
    const double ring = std::hypot(p.x(), p.y()) - 0.7;
    return std::max(0.2 - std::hypot(ring, p.z()), ball(p, {0, 0, 1}, 0.3));
  }), 0.0F);
  EXPECT_TRUE(examine_topology(mesh).closed);
  EXPECT_EQ(examine_topology(mesh).components, 2);
  const TriangleMesh torus = largest_component(mesh);
  EXPECT_EQ(examine_topology(torus).components, 1);
  EXPECT_EQ(examine_topology(torus).euler_characteristic, 0);
  const auto few = simplified(torus, 300);
  ASSERT_TRUE(few);
  EXPECT_LT(few->vertices.size(), 400U);
  EXPECT_EQ(examine_topology(*few).euler_characteristic, 0);
  EXPECT_NEAR(signed_volume(*few) / signed_volume(torus), 1, 0.05);
}

TEST(Isosurface, OfNothingIsNothing) {
  const TriangleMesh mesh = isosurface(sampled(0.5, [](const Vector3d&) { return -1.0; }), 0.0F);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_TRUE(largest_component(mesh).triangles.empty());
}

}  // namespace
}  // namespace gfp
