#include <gtest/gtest.h>

#include "gfp/core/mesh.hpp"
#include "gfp/core/random.hpp"

namespace gfp {
namespace {

TEST(CircumscribedSphere, OfFewPointsIsTheClosedForm) {
  EXPECT_EQ(circumscribed_sphere({}).radius, 0);
  EXPECT_EQ(circumscribed_sphere({{1, 2, 3}}).radius, 0);
  const Sphere pair = circumscribed_sphere({{0, 0, 0}, {2, 0, 0}});
  EXPECT_NEAR(pair.radius, 1, 1e-12);
  EXPECT_TRUE(pair.centre.isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));
  std::vector<Eigen::Vector3d> cube;
  for (int k = 0; k < 8; ++k) cube.emplace_back(k & 1, (k >> 1) & 1, (k >> 2) & 1);
  EXPECT_NEAR(circumscribed_sphere(cube).radius, std::sqrt(0.75), 1e-12);
}

// Every point inside, and no smaller sphere: the centre lies in the hull of the points on the boundary, so moving it any way
// brings one of them outside.
TEST(CircumscribedSphere, IsSmallest) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 500; ++k) points.emplace_back(random.normal(), 2 * random.normal(), 0.5 * random.normal());
    const Sphere sphere = circumscribed_sphere(points);
    double farthest = 0;
    for (const auto& p : points) farthest = std::max(farthest, (p - sphere.centre).norm());
    EXPECT_NEAR(farthest, sphere.radius, 1e-9 * sphere.radius) << "seed " << seed;
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector3d moved = sphere.centre + 1e-3 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
      double radius = 0;
      for (const auto& p : points) radius = std::max(radius, (p - moved).norm());
      EXPECT_GE(radius, sphere.radius - 1e-9) << "seed " << seed;
    }
  }
}

TEST(CircumscribedSphere, CopesWithRepeatedAndFlatPoints) {
  std::vector<Eigen::Vector3d> points(50, {0.1, 0.2, 0.3});
  EXPECT_NEAR(circumscribed_sphere(points).radius, 0, 1e-12);
  for (int k = 0; k < 50; ++k) points.emplace_back(0.1 + 0.01 * k, 0.2, 0.3);
  EXPECT_NEAR(circumscribed_sphere(points).radius, 0.245, 1e-9);
}

}  // namespace
}  // namespace gfp
