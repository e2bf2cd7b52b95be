#include "gfp/collection/close_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gfp/core/random.hpp"
#include "gfp/core/simplified.hpp"
#include "gfp/evaluation/triangle_tree.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

int genus(const TriangleMesh& mesh) { return 1 - (static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2) / 2; }

double farthest(const TriangleMesh& from, const TriangleMesh& to) {
  const TriangleTree tree(to);
  double most = 0;
  for (const auto& v : from.vertices) most = std::max(most, tree.closest(v).distance_m);
  return most;
}

/// Every third triangle turned around, every vertex its own, one in forty missing: what collections are made of.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % 40 == 7) continue;
    const auto first = static_cast<std::int32_t>(soup.vertices.size());
    for (const auto v : mesh.triangles[t]) soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    if (t % 3 == 0) soup.triangles.push_back({first, first + 2, first + 1});
    else soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

void expect_sound(const TriangleMesh& mesh, int expected_genus) {
  EXPECT_TRUE(examine_topology(mesh).closed);
  EXPECT_EQ(examine_topology(mesh).components, 1);
  EXPECT_EQ(genus(mesh), expected_genus);
  EXPECT_EQ(count_self_intersections(mesh), 0);
  EXPECT_GT(signed_volume(mesh), 0) << "oriented outwards";
}

TEST(CloseSurface, GivesBackASphere) {
  const TriangleMesh sphere = test::sphere(0.1, 48, 24);
  const auto closed = close_surface(sphere);
  ASSERT_TRUE(closed);
  expect_sound(*closed, 0);
  EXPECT_LT(farthest(*closed, sphere), 0.002);
  EXPECT_NEAR(signed_volume(*closed), 4.0 / 3 * std::numbers::pi * 1e-3, 0.03e-3 * 4);
}

TEST(CloseSurface, MendsASoupAndKeepsItsHole) {
  const TriangleMesh torus = test::torus(0.1, 0.03);
  const auto closed = close_surface(soup_of(torus));
  ASSERT_TRUE(closed);
  expect_sound(*closed, 1);
  EXPECT_LT(farthest(*closed, torus), 0.006);
}

TEST(CloseSurface, GivesASheetAThickness) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.2, 0}, {0, 0.2, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto closed = close_surface(sheet);
  ASSERT_TRUE(closed);
  expect_sound(*closed, 0);
}

// A bowl drawn as one open sheet gets a wall; a wall as thick as a voxel keeps its thickness, and no more.
TEST(CloseSurface, KeepsThinWallsThin) {
  std::vector<Eigen::Vector2d> outer, both;
  for (int i = 1; i <= 16; ++i) outer.emplace_back(0.08 * std::sin(i * 0.098), 0.08 - 0.08 * std::cos(i * 0.098));
  both = outer;
  for (int i = 16; i >= 1; --i) both.emplace_back(0.078 * std::sin(i * 0.098), 0.08 - 0.078 * std::cos(i * 0.098));
  TriangleMesh sheet = test::revolve(outer, 48);
  sheet.triangles.erase(std::remove_if(sheet.triangles.begin(), sheet.triangles.end(), [&](const Triangle& t) { return std::max({t[0], t[1], t[2]}) == static_cast<int>(sheet.vertices.size()) - 1; }), sheet.triangles.end());
  const auto closed = close_surface(sheet), soup = close_surface(soup_of(test::revolve(both, 48)));
  ASSERT_TRUE(closed && soup);
  expect_sound(*closed, 0);
  expect_sound(*soup, 0);
  const double area = surface_area(sheet), voxel_m = 0.16 / 80;
  EXPECT_NEAR(signed_volume(*closed) / area, 0.6 * voxel_m, 0.3 * voxel_m);
  EXPECT_NEAR(signed_volume(*soup) / area, 0.002, 0.0008);
}

TEST(CloseSurface, TakesASoundSurfaceAsItIs) {
  TriangleMesh torus = test::torus(0.1, 0.03);
  for (Triangle& t : torus.triangles) std::swap(t[1], t[2]);  // inside out
  const auto closed = close_surface(torus, {.vertices = static_cast<int>(torus.vertices.size())});
  ASSERT_TRUE(closed);
  expect_sound(*closed, 1);
  EXPECT_LT(farthest(*closed, torus), 1e-9);
}

// Triangles missing, doubled, turned around and torn apart, vertices thrown far off: a sound surface, or a reason.
TEST(CloseSurface, DamageGivesASoundSurfaceOrAReason) {
  int closed_ones = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    TriangleMesh mesh = seed % 2 == 0 ? test::torus(0.1, 0.03) : test::sphere(0.1, 24, 12);
    for (int damage = 1 + random.below(40); damage > 0; --damage) {
      const auto t = static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())));
      const auto v = static_cast<std::size_t>(random.below(static_cast<int>(mesh.vertices.size())));
      switch (random.below(6)) {
        case 0: mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t)); break;
        case 1: mesh.triangles.push_back(mesh.triangles[t]); break;
        case 2: std::swap(mesh.triangles[t][0], mesh.triangles[t][1]); break;
        case 3: mesh.triangles[t][0] = static_cast<std::int32_t>(v); break;
        case 4: mesh.vertices[v] *= random.uniform(-1, 2); break;
        default: mesh.vertices.emplace_back(1e9, -1e9, 1e12);  // used by nobody
      }
    }
    const auto closed = close_surface(mesh, {.voxels = 24, .vertices = 400});
    if (!closed) continue;
    ++closed_ones;
    EXPECT_TRUE(examine_topology(*closed).closed) << seed;
    EXPECT_EQ(count_self_intersections(*closed), 0) << seed;
    EXPECT_GT(signed_volume(*closed), 0) << seed;
  }
  EXPECT_GT(closed_ones, 25);
}

TEST(CloseSurface, NeedlesFarThingsAndDustEndSoon) {
  TriangleMesh needle = test::box({1e-6, 1e-6, 1.0}), far = test::sphere(0.05);
  for (auto& v : far.vertices) v += Eigen::Vector3d(1e3, -1e3, 1e3);
  EXPECT_TRUE(close_surface(far));
  const auto closed_needle = close_surface(needle);
  EXPECT_TRUE(!closed_needle || examine_topology(*closed_needle).closed);
  TriangleMesh dust;
  Random random(3);
  for (int k = 0; k < 20'000; ++k) {
    const Eigen::Vector3d p(random.uniform(0, 0.3), random.uniform(0, 0.3), random.uniform(0, 0.3));
    const auto first = static_cast<std::int32_t>(dust.vertices.size());
    for (int axis = 0; axis < 3; ++axis) dust.vertices.push_back(p + 0.002 * Eigen::Vector3d::Unit(axis));
    dust.triangles.push_back({first, first + 1, first + 2});
  }
  const auto closed_dust = close_surface(dust, {.voxels = 24, .vertices = 1000});
  EXPECT_TRUE(!closed_dust || count_self_intersections(*closed_dust) == 0);
}

TEST(CloseSurface, SaysWhatIsNoBody) {
  EXPECT_EQ(close_surface({}).error().code, ErrorCode::kDegenerateGeometry);
  TriangleMesh point;
  point.vertices = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  point.triangles = {{0, 1, 2}};
  EXPECT_EQ(close_surface(point).error().code, ErrorCode::kDegenerateGeometry);
}

// A shell a millimetre thick with few vertices: its walls would pass through each other, so it is left finer where they do.
TEST(Simplified, NeverCrossesThinWalls) {
  std::vector<Eigen::Vector2d> both;
  for (int i = 1; i <= 24; ++i) both.emplace_back(0.08 * std::sin(i * 0.065), 0.08 - 0.08 * std::cos(i * 0.065));
  for (int i = 24; i >= 1; --i) both.emplace_back(0.0796 * std::sin(i * 0.065), 0.08 - 0.0796 * std::cos(i * 0.065));
  const TriangleMesh shell = test::revolve(both, 64);
  ASSERT_EQ(count_self_intersections(shell), 0);
  for (const int vertices : {100, 200, 400}) {
    const auto few = simplified(shell, vertices);
    ASSERT_TRUE(few) << vertices;
    expect_sound(*few, 0);
    EXPECT_LT(few->vertices.size(), shell.vertices.size());
  }
}

TEST(Simplified, KeepsShapeAndGenus) {
  const TriangleMesh torus = test::torus(0.1, 0.03);
  const TriangleMesh few = *simplified(torus, 200);
  EXPECT_LE(few.vertices.size(), 200U);
  expect_sound(few, 1);
  EXPECT_NEAR(signed_volume(few), signed_volume(torus), 0.05 * signed_volume(torus));
}

}  // namespace
}  // namespace gfp
