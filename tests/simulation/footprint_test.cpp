#include "simulation/footprint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

using Eigen::Vector2d;

Polygon square(double half, const Vector2d& centre = Vector2d::Zero()) {
  return convex_hull({centre + Vector2d(-half, -half), centre + Vector2d(half, -half), centre + Vector2d(half, half), centre + Vector2d(-half, half)});
}

TEST(Footprint, HullKeepsTheCornersAlone) {
  EXPECT_EQ(convex_hull({{0, 0}, {1, 0}, {0.5, 0}, {1, 1}, {0.5, 0.5}, {0, 1}, {0, 0}}).size(), 4U);
  EXPECT_EQ(convex_hull({{2, 3}}).size(), 1U);
  EXPECT_EQ(convex_hull({{2, 3}, {2, 3}}).size(), 1U);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size(), 2U);
}

TEST(Footprint, HullHoldsEveryPointOnItsLeft) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    std::vector<Vector2d> points;
    for (int i = 0; i < 50; ++i) points.emplace_back(random.normal(), random.normal());
    const Polygon hull = convex_hull(points);
    for (const Vector2d& p : points) EXPECT_NEAR((nearest_point(hull, p) - p).norm(), 0, 1e-12) << seed;
  }
}

TEST(Footprint, SeparationOfSquares) {
  EXPECT_NEAR(separation(square(1), square(1, {3, 0.5})), 1, 1e-12);
  EXPECT_NEAR(separation(square(1), square(1, {1.5, 0})), -0.5, 1e-12);
  EXPECT_LT(separation(square(1), square(0.1)), 0);  // one inside the other
}

TEST(Footprint, NearestPointOnEdgeCornerAndInside) {
  EXPECT_TRUE(nearest_point(square(1), {3, 0.25}).isApprox(Vector2d(1, 0.25)));
  EXPECT_TRUE(nearest_point(square(1), {3, 4}).isApprox(Vector2d(1, 1)));
  EXPECT_TRUE(nearest_point(square(1), {0.5, 0.25}).isApprox(Vector2d(0.5, 0.25)));
  EXPECT_TRUE(nearest_point({{1, 2}}, {0, 0}).isApprox(Vector2d(1, 2)));
}

}  // namespace
}  // namespace gfp
