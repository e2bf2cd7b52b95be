#include "gfp/core/mesh.hpp"

#include <gtest/gtest.h>

#include "gfp/core/random.hpp"
#include "gfp/core/self_intersections.hpp"
#include "support/shapes.hpp"

namespace gfp {
namespace {

TEST(ExamineTopology, KnowsSolidsByTheirEulerCharacteristic) {
  for (const auto& mesh : {test::box({0.1, 0.2, 0.3}), test::sphere(0.1), test::cylinder(0.05, 0.1)}) {
    const MeshTopology topology = examine_topology(mesh);
    EXPECT_TRUE(topology.closed);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.euler_characteristic, 2);
  }
  EXPECT_EQ(examine_topology(test::torus(0.1, 0.02)).euler_characteristic, 0);
  EXPECT_TRUE(examine_topology(test::torus(0.1, 0.02)).closed);
}

TEST(ExamineTopology, SeesAHole) {
  TriangleMesh mesh = test::box({0.1, 0.1, 0.1});
  mesh.triangles.pop_back();
  const MeshTopology topology = examine_topology(mesh);
  EXPECT_FALSE(topology.closed);
  EXPECT_EQ(topology.boundary_edges, 3);
}

TEST(ExamineTopology, SeesAFlippedTriangle) {
  TriangleMesh mesh = test::box({0.1, 0.1, 0.1});
  std::swap(mesh.triangles[0][1], mesh.triangles[0][2]);
  const MeshTopology topology = examine_topology(mesh);
  EXPECT_FALSE(topology.closed);
  EXPECT_EQ(topology.nonmanifold_edges, 3);
}

TEST(ExamineTopology, SeesTwoSolidsThatTouchInOneVertex) {
  TriangleMesh mesh = test::box({0.1, 0.1, 0.1});
  TriangleMesh other = test::box({0.1, 0.1, 0.1});
  append(mesh, other);
  for (auto& t : mesh.triangles)
    for (auto& v : t)
      if (v == 8) v = 7;  // the other's first corner is ours
  const MeshTopology topology = examine_topology(mesh);
  EXPECT_EQ(topology.nonmanifold_vertices, 1);
  EXPECT_FALSE(topology.closed);
}

TEST(Volume, IsTheClosedForm) {
  EXPECT_NEAR(signed_volume(test::box({0.1, 0.2, 0.3})), 0.006, 1e-15);
  EXPECT_NEAR(surface_area(test::box({0.1, 0.2, 0.3})), 0.22, 1e-15);
  EXPECT_TRUE(volume_centroid(test::box({0.1, 0.2, 0.3})).isApprox(Eigen::Vector3d(0, 0, 0.15), 1e-12));
  // A polygonal torus is inside the round one; 1 % of volume at 64 x 32.
  const double exact = 2 * std::numbers::pi * std::numbers::pi * 0.1 * 0.02 * 0.02;
  EXPECT_NEAR(signed_volume(test::torus(0.1, 0.02, 64, 32)), exact, 0.01 * exact);
}

TEST(VertexNormals, PointOutwardsOnASphere) {
  const TriangleMesh mesh = test::sphere(0.1);
  const auto normals = vertex_normals(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) EXPECT_GT(normals[i].dot(mesh.vertices[i].normalized()), 0.99);
}

TEST(SelfIntersections, NoneInSolids) {
  EXPECT_EQ(count_self_intersections(test::box({0.1, 0.2, 0.3})), 0);
  EXPECT_EQ(count_self_intersections(test::sphere(0.1)), 0);
  EXPECT_EQ(count_self_intersections(test::torus(0.1, 0.02)), 0);
}

TEST(SelfIntersections, FindAnInvertedTube) {
  EXPECT_GT(count_self_intersections(test::torus(0.05, 0.06)), 0);  // a spindle torus runs through itself
}

TEST(SelfIntersections, AgreeWithBruteForceOnTwoMovedSpheres) {
  for (const double shift : {0.05, 0.15, 0.17, 0.21}) {
    TriangleMesh mesh = test::sphere(0.1, 12, 8);
    append(mesh, transformed(test::sphere(0.1, 12, 8), Transform(Eigen::Translation3d(shift, 0.013, 0.007))));
    int brute_force = 0;
    for (std::size_t a = 0; a < mesh.triangles.size(); ++a)
      for (std::size_t b = a + 1; b < mesh.triangles.size(); ++b) {
        TriangleMesh pair{mesh.vertices, {mesh.triangles[a], mesh.triangles[b]}};
        brute_force += count_self_intersections(pair);
      }
    EXPECT_EQ(count_self_intersections(mesh), brute_force) << "shift " << shift;
    EXPECT_EQ(brute_force > 0, shift < 0.2) << "shift " << shift;
  }
}

TEST(SelfIntersections, SeeAFlatFold) {
  // Two triangles that share an edge and lie on each other.
  const TriangleMesh mesh{{{0, 0, 0}, {0.1, 0, 0}, {0.05, 0.1, 0}, {0.05, 0.08, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(count_self_intersections(mesh), 1);
  const TriangleMesh open{{{0, 0, 0}, {0.1, 0, 0}, {0.05, 0.1, 0}, {0.05, -0.08, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(count_self_intersections(open), 0);
}

// A slab whose top is pushed through its bottom in one place: it stops there, and goes all the way elsewhere.
TEST(ApproachWithoutCrossing, StopsOnlyWhereItMust) {
  const TriangleMesh slab = test::cylinder(0.1, 0.02, 64, 12);  // its two lids are fans: their middles are the last two vertices
  const auto bottom = slab.vertices.size() - 2, top = slab.vertices.size() - 1;
  std::vector<Eigen::Vector3d> wanted = slab.vertices;
  for (auto& p : wanted) p.x() += 0.01;
  wanted[top] += Eigen::Vector3d(0.003, 0.0017, -0.07);  // off its axis: no edge passes through an edge
  ASSERT_FALSE(find_self_intersections({wanted, slab.triangles}).empty());
  const Approach moved = approach_without_crossing(slab.vertices, wanted, slab.triangles);
  EXPECT_EQ(count_self_intersections({moved.vertices, slab.triangles}), 0);
  EXPECT_LT(moved.share[top], 1);
  EXPECT_GT(moved.share[top], 0);
  EXPECT_GT(moved.vertices[top].z(), moved.vertices[bottom].z());
  EXPECT_EQ(moved.share[6 * 64], 1) << "the middle of the side";
}

TEST(ApproachWithoutCrossing, EndsWithTheSoundOneAtWorst) {
  const TriangleMesh sphere = test::sphere(0.1);
  std::vector<Eigen::Vector3d> inside_out;
  for (const auto& p : sphere.vertices) inside_out.emplace_back(-p.x(), p.y() * p.x() * 30, p.z() * p.y() * 40);
  const Approach moved = approach_without_crossing(sphere.vertices, inside_out, sphere.triangles);
  EXPECT_EQ(count_self_intersections({moved.vertices, sphere.triangles}), 0);
}

TEST(FindSelfIntersections, NamesTheTrianglesThatAreCounted) {
  TriangleMesh mesh = test::box({0.1, 0.1, 0.1});
  TriangleMesh other = test::box({0.05, 0.05, 0.3});
  for (auto& v : other.vertices) v.z() -= 0.1;
  append(mesh, other);
  const auto pairs = find_self_intersections(mesh);
  EXPECT_EQ(static_cast<int>(pairs.size()), count_self_intersections(mesh));
  ASSERT_FALSE(pairs.empty());
  for (const auto& pair : pairs) EXPECT_NE(pair[0] < 12, pair[1] < 12) << "one of each box";
}

}  // namespace
}  // namespace gfp
