#include "gfp/evaluation/triangle_tree.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"
#include "gfp/evaluation/surface_samples.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

Eigen::Vector3d random_point(Random& random) { return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; }

// Loose triangles of all sizes, needles and points among them.
TriangleMesh triangle_soup(int count, Random& random) {
  TriangleMesh mesh;
  for (int t = 0; t < count; ++t) {
    const Eigen::Vector3d centre = random_point(random);
    const double size = random.uniform(0, 0.3) * (t % 7 == 0 ? 0.0 : 1.0);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(centre + size * random_point(random));
    if (t % 11 == 0) mesh.vertices.back() = mesh.vertices[mesh.vertices.size() - 2];
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

// Least distance over a fine barycentric grid: an upper bound that the exact answer stays just below.
double gridded_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  constexpr int kSteps = 60;
  double best = 1e300;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j)
      best = std::min(best, (a + (b - a) * i / kSteps + (c - a) * j / kSteps - p).norm());
  return best;
}

TEST(ClosestOnTriangle, AgreesWithAFineGridOverTheTriangle) {
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d p = random_point(random), a = random_point(random), b = trial % 5 == 0 ? a : random_point(random), c = random_point(random);
    const double exact = (closest_on_triangle(p, a, b, c) - p).norm(), gridded = gridded_distance(p, a, b, c);
    EXPECT_LE(exact, gridded + 1e-12) << "trial " << trial;
    EXPECT_GE(exact, gridded - 0.06) << "trial " << trial;  // the grid's pitch
  }
}

TEST(TriangleTree, FindsTheSameNearestDistanceAsAllTrianglesOneByOne) {
  Random random(5);
  const TriangleMesh soup = triangle_soup(500, random);
  const TriangleTree tree(soup);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d p = 1.5 * random_point(random);
    double best = 1e300;
    for (const Triangle& t : soup.triangles)
      best = std::min(best, (closest_on_triangle(p, soup.vertices[static_cast<std::size_t>(t[0])], soup.vertices[static_cast<std::size_t>(t[1])], soup.vertices[static_cast<std::size_t>(t[2])]) - p).norm());
    const auto found = tree.closest(p);
    EXPECT_NEAR(found.distance_m, best, 1e-12) << "trial " << trial;
    EXPECT_NEAR((found.point - p).norm(), best, 1e-12) << "trial " << trial;
    EXPECT_EQ(tree.closest(p, 0.5 * best).triangle, -1) << "trial " << trial;
  }
}

TEST(TriangleTree, SegmentsAreBlockedExactlyWhenTheyPassThroughTheSphere) {
  const TriangleTree tree(test::sphere(0.5, 64, 32));
  Random random(7);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector3d from = 2 * random_point(random).normalized(), to = 2 * random_point(random).normalized();
    const double miss = from.cross(to - from).norm() / (to - from).norm();  // both ends are outside
    if (std::abs(miss - 0.5) < 0.005) continue;                            // the facets are not a sphere
    EXPECT_EQ(tree.blocks(from, to), miss < 0.5) << "trial " << trial << ", miss " << miss;
  }
}

TEST(TriangleTree, BoxesSeenAlongTheirAxesAreCrossed) {
  const TriangleTree tree(test::box({0.2, 0.2, 0.2}));
  EXPECT_TRUE(tree.blocks({0.03, 0.04, 1}, {0.03, 0.04, -1}));
  EXPECT_FALSE(tree.blocks({0.11, 0.04, 1}, {0.11, 0.04, -1}));
  EXPECT_FALSE(tree.blocks({0.03, 0.04, 1}, {0.03, 0.04, 0.21}));
}

// A shell 10 mm thick: from its outside the outer wall is found, never the inner one, which faces the other way.
TEST(TriangleTree, CrossingsFaceTheSameWay) {
  TriangleMesh shell = test::sphere(0.05, 64, 32), inner = test::sphere(0.04, 64, 32);
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append(shell, inner);
  const TriangleTree tree(shell);
  const Eigen::Vector3d out = Eigen::Vector3d(1, 2, 3).normalized();
  const auto from_outside = tree.crossing_along(0.053 * out, out, 0.02), from_the_wall = tree.crossing_along(0.041 * out, out, 0.02);
  ASSERT_TRUE(from_outside && from_the_wall);
  EXPECT_NEAR(*from_outside, -0.003, 1e-4);
  EXPECT_NEAR(*from_the_wall, 0.009, 1e-4);
  EXPECT_FALSE(tree.crossing_along(0.08 * out, out, 0.02));
}

TEST(TriangleTree, AnEmptyMeshIsInfinitelyFar) {
  const TriangleTree tree{TriangleMesh{}};
  EXPECT_EQ(tree.closest({0, 0, 0}).triangle, -1);
  EXPECT_TRUE(std::isinf(tree.closest({0, 0, 0}).distance_m));
  EXPECT_FALSE(tree.blocks({0, 0, 0}, {1, 0, 0}));
}

// The share of samples on a face is its share of the area; their mean is the box's centre.
TEST(SampleSurface, IsUniformByArea) {
  const TriangleMesh mesh = test::box({0.4, 0.2, 0.1});
  const SurfaceSamples samples = sample_surface(mesh, 4000, 1);
  ASSERT_EQ(samples.points.size(), 4000U);
  int on_top = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    sum += samples.points[i];
    on_top += samples.normals[i].z() > 0.5 ? 1 : 0;
  }
  const double top_share = 0.08 / surface_area(mesh);
  EXPECT_NEAR(on_top / 4000.0, top_share, 0.001);  // stratified: off by one sample a triangle
  EXPECT_LT((sum / 4000 - Eigen::Vector3d(0, 0, 0.05)).norm(), 0.01);  // three sigma of 4000 points
}

TEST(SampleSurface, NoAreaGivesNoSamples) {
  EXPECT_TRUE(sample_surface({}, 100, 1).points.empty());
  EXPECT_TRUE(sample_surface({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}}, 100, 1).points.empty());
}

}  // namespace
}  // namespace gfp
