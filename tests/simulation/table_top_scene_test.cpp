#include "gfp/simulation/table_top_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gfp/primitive/families.hpp"
#include "simulation/footprint.hpp"

namespace gfp {
namespace {

std::vector<Polygon> footprints(const VirtualScene& scene) {
  std::vector<Polygon> all;
  for (const PlacedMesh& object : scene.objects) {
    std::vector<Eigen::Vector2d> points;
    for (const auto& vertex : object.mesh.vertices) points.emplace_back((object.T_world_object * vertex).head<2>());
    all.push_back(convex_hull(std::move(points)));
  }
  return all;
}

double nearest_neighbour(const std::vector<Polygon>& all, std::size_t i) {
  double gap = 1e9;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (j != i) gap = std::min(gap, separation(all[i], all[j]));
  return gap;
}

TEST(TableTopScene, ObjectsRestExactlyOnTheTableAndDoNotOverlap) {
  for (const double clutter : {0.0, 0.5, 1.0})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      TableTopOptions options;
      options.objects = 8;
      options.clutter = clutter;
      options.resting_otherwise = 0.5;
      const VirtualScene scene = table_top_scene(options, seed);
      ASSERT_EQ(scene.objects.size(), 8U);
      const auto outlines = footprints(scene);
      for (std::size_t i = 0; i < 8; ++i) {
        double lowest = 1e9;
        for (const auto& vertex : scene.objects[i].mesh.vertices) lowest = std::min(lowest, (scene.objects[i].T_world_object * vertex).z());
        EXPECT_NEAR(lowest, 0, 1e-12) << seed;
        EXPECT_GT(nearest_neighbour(outlines, i), 0.0009) << seed;
        for (const auto& corner : outlines[i]) {
          EXPECT_LT(std::abs(corner.x()), scene.table_half_x_m);
          EXPECT_LT(std::abs(corner.y()), scene.table_half_y_m);
        }
      }
    }
}

TEST(TableTopScene, ClutterMakesObjectsTouch) {
  int touching_apart = 0, touching_cluttered = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const double clutter : {0.0, 1.0}) {
      TableTopOptions options;
      options.clutter = clutter;
      const auto outlines = footprints(table_top_scene(options, seed));
      for (std::size_t i = 0; i < outlines.size(); ++i)
        (clutter > 0 ? touching_cluttered : touching_apart) += nearest_neighbour(outlines, i) < 0.004 ? 1 : 0;
    }
  EXPECT_EQ(touching_apart, 0);
  EXPECT_GT(touching_cluttered, 45);  // of 50: all but rare ones that found no place beside another
}

TEST(TableTopScene, TheWantedShareDoesNotStandUpright) {
  const auto lying = [](double share) {
    int count = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      TableTopOptions options;
      options.resting_otherwise = share;
      for (const PlacedMesh& object : table_top_scene(options, seed).objects) count += object.T_world_object.linear()(2, 2) < 0.9 ? 1 : 0;
    }
    return count;
  };
  EXPECT_LE(lying(0), 5);  // of 100: a thing without a base may not stand at all
  EXPECT_GT(lying(1), 75); // flat things stand up again from nearly any fall
  EXPECT_GT(lying(0.3), 15);
  EXPECT_LT(lying(0.3), 50);
}

TEST(TableTopScene, IsItsSeed) {
  const auto poses = [](std::uint64_t seed) {
    std::vector<double> values;
    for (const PlacedMesh& object : table_top_scene({}, seed).objects) {
      values.push_back(object.T_world_object.translation().x());
      values.push_back(object.mesh.vertices[3].x());
    }
    return values;
  };
  EXPECT_EQ(poses(4), poses(4));
  EXPECT_NE(poses(4), poses(5));
}

TEST(TableTopScene, TakesTheClassesAskedForAndUsesThemAll) {
  std::set<std::string> seen;
  TableTopOptions options;
  options.objects = 12;
  options.classes = {"mug", "box", "no such class"};
  for (const PlacedMesh& object : table_top_scene(options, 3).objects) seen.insert(object.class_name);
  EXPECT_EQ(seen, (std::set<std::string>{"box", "mug"}));
  options.classes = {"no such class"};
  EXPECT_TRUE(table_top_scene(options, 3).objects.empty());
}

TEST(TableTopScene, HundredObjectsGetALargerTable) {
  TableTopOptions options;
  options.objects = 100;
  options.clutter = 0.3;
  const VirtualScene scene = table_top_scene(options, 1);
  EXPECT_EQ(scene.objects.size(), 100U);
  EXPECT_GT(scene.table_half_x_m, VirtualScene{}.table_half_x_m);
  const auto outlines = footprints(scene);
  for (std::size_t i = 0; i < outlines.size(); ++i) EXPECT_GT(nearest_neighbour(outlines, i), 0.0009);
}

}  // namespace
}  // namespace gfp
