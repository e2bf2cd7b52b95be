#include "gfp/core/voxel_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "gfp/core/random.hpp"

namespace gfp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float squared_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const float dx = a.x() - b.x(), dy = a.y() - b.y(), dz = a.z() - b.z();
  return dx * dx + dy * dy + dz * dz;
}

int brute_force(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& centre, float radius) {
  return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const auto& p) { return squared_distance(p, centre) <= radius * radius; }));
}

/// A wavy sheet 0.8 m from the camera in steps of 1.5 mm, like an object's surface in a depth image; some points are missing.
std::vector<Eigen::Vector3f> sheet(std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < 50; ++v)
    for (int u = 0; u < 50; ++u) {
      const double x = 0.0015 * u - 0.3, y = 0.0015 * v + 0.1, z = 0.8 + 0.02 * std::sin(60 * x) * std::cos(40 * y) + 0.001 * random.normal();
      points.emplace_back(random.uniform() < 0.05 ? kNaN : static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  return points;
}

TEST(VoxelGrid, CountsExactlyWhatBruteForceCounts) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto points = sheet(seed);
    Random random(seed + 100);
    for (const float cell : {0.002F, 0.003F, 0.01F, 0.05F}) {
      const VoxelGrid grid(points, cell);
      for (int query = 0; query < 200; ++query) {
        const auto& on = points[static_cast<std::size_t>(random.below(static_cast<int>(points.size())))];
        const Eigen::Vector3f centre(static_cast<float>(random.uniform(-0.31, -0.21)), on.y(), on.z());
        const float radius = static_cast<float>(random.uniform(0, 0.015));
        ASSERT_EQ(grid.count_within(centre, radius), brute_force(points, centre, radius)) << "seed " << seed << " cell " << cell << " radius " << radius;
      }
    }
  }
}

// Points on a lattice as wide as the cells: every distance and every cell border is hit exactly.
TEST(VoxelGrid, IsExactWherePointsLieOnTheSphereAndOnCellBorders) {
  std::vector<Eigen::Vector3f> points;
  for (int z = -4; z <= 4; ++z)
    for (int y = -4; y <= 4; ++y)
      for (int x = -4; x <= 4; ++x) points.push_back(0.25F * Eigen::Vector3i(x, y, z).cast<float>());
  const VoxelGrid grid(points, 0.25F);
  EXPECT_EQ(grid.count_within({0, 0, 0}, 0.25F), 7);
  EXPECT_EQ(grid.count_within({0, 0, 0}, 0.5F), 33);  // lattice points within two steps
  EXPECT_EQ(grid.count_within({0, 0, 0}, 0.0F), 1);
  EXPECT_EQ(grid.count_within({0.125F, 0, 0}, 0.124F), 0);
}

TEST(VoxelGrid, AnswersNothingWithNothing) {
  const VoxelGrid empty({}, 0.01F);
  EXPECT_EQ(empty.count_within({0, 0, 0}, 1.0F), 0);
  const std::vector<Eigen::Vector3f> blind(3, Eigen::Vector3f::Constant(kNaN));
  EXPECT_EQ(VoxelGrid(blind, 0.01F).size(), 0U);
  const std::vector<Eigen::Vector3f> one{{1, 2, 3}};
  const VoxelGrid grid(one, 0.01F);
  EXPECT_EQ(grid.count_within({kNaN, 2, 3}, 1.0F), 0);
  EXPECT_EQ(grid.count_within({1, 2, 3}, kNaN), 0);
  EXPECT_EQ(grid.count_within({1e30F, 2, 3}, 1.0F), 0);
}

// An outlier a kilometre away must not cost memory: the cell grows instead, and the answers stay exact.
TEST(VoxelGrid, BoundsItsMemoryWhereAPointIsFarAway) {
  auto points = sheet(9);
  points.emplace_back(1000.0F, -700.0F, 500.0F);
  const VoxelGrid grid(points, 0.003F);
  EXPECT_GT(grid.cell_m(), 1.0F);
  const Eigen::Vector3f centre = points[1000];
  EXPECT_EQ(grid.count_within(centre, 0.01F), brute_force(points, centre, 0.01F));
  EXPECT_EQ(grid.count_within({1000.0F, -700.0F, 500.0F}, 0.01F), 1);
}

}  // namespace
}  // namespace gfp
