#include "gfp/core/closest_point.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

// Brute force: no point of a dense sampling of the triangle is nearer.
TEST(ClosestPointOnTriangle, BeatsADenseSampling) {
  Random random(3);
  const auto point = [&random] { return Eigen::Vector3d(random.normal(), random.normal(), random.normal()); };
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d a = point(), b = point(), c = k % 10 == 0 ? Eigen::Vector3d(a + 0.3 * (b - a)) : point(), p = 2 * point();
    const double distance = (closest_point_on_triangle(p, a, b, c) - p).norm();
    double sampled = 1e300;
    for (int u = 0; u <= 40; ++u)
      for (int v = 0; u + v <= 40; ++v) sampled = std::min(sampled, (a + (b - a) * u / 40.0 + (c - a) * v / 40.0 - p).norm());
    EXPECT_LE(distance, sampled + 1e-12) << k;
    EXPECT_GE(distance, sampled - 0.15) << k;  // half the sampling's pitch on the largest triangles
  }
}

}  // namespace
}  // namespace gfp
