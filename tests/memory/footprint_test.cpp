#include "memory/footprint.hpp"

#include <gtest/gtest.h>

#include "gfp/core/convex_hull.hpp"
#include "gfp/core/random.hpp"
#include "support/block_scene.hpp"

namespace gfp {
namespace {

double signed_area(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

TEST(ConvexHull, OfASquareWithPointsInsideAndOnItsEdgesIsItsCorners) {
  const auto hull = convex_hull({{0, 0}, {0.5, 0}, {1, 0}, {0.3, 0.4}, {1, 1}, {0.5, 1}, {0, 1}, {0, 0}});
  EXPECT_EQ(hull.size(), 4U);
  EXPECT_DOUBLE_EQ(signed_area(hull), 1.0);  // positive: counter-clockwise
}

TEST(ConvexHull, HoldsAllPointsAndTurnsLeftOnly) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 200; ++i) points.emplace_back(random.normal(), random.normal());
    const auto hull = convex_hull(points);
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d a = hull[i], edge = hull[(i + 1) % hull.size()] - a;
      for (const auto& p : points) EXPECT_GE(edge.x() * (p - a).y() - edge.y() * (p - a).x(), -1e-12);
    }
  }
}

TEST(ConvexHull, OfFewOrCollinearPointsIsNotAPolygon) {
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_EQ(convex_hull({{1, 2}, {1, 2}}).size(), 1U);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}, {3, 3}}).size(), 2U);
}

// 20 x 10 pixels seen head-on at 0.8 m cover 19 x 9 pixel pitches.
TEST(Footprint, HasTheSizeOfTheSeenFace) {
  const auto scene = test::block_scene({{{30, 40, 50, 50}, 0.8}});
  const auto outline = footprint(scene.segments.segments[0], scene.cloud, scene.segments.planes[0].T_camera_support);
  const double pitch_m = 0.8 / scene.frame.camera.fx;
  EXPECT_NEAR(signed_area(outline), 19 * pitch_m * 9 * pitch_m, 1e-7);  // float coordinates
}

}  // namespace
}  // namespace gfp
