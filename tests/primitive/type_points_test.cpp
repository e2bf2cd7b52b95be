#include "gfp/primitive/type_points.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "gfp/primitive/families.hpp"
#include "gfp/primitive/stable_poses.hpp"

namespace gfp {
namespace {

/// A block of n x n x n cells with sharp edges.
TriangleMesh sharp_block(int n, const Eigen::Vector3d& size_m) {
  TriangleMesh mesh;
  std::vector<std::int32_t> index(static_cast<std::size_t>((n + 1) * (n + 1) * (n + 1)), -1);
  const auto vertex = [&](int i, int j, int k) {
    auto& v = index[static_cast<std::size_t>((i * (n + 1) + j) * (n + 1) + k)];
    if (v < 0) {
      v = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.push_back(size_m.cwiseProduct(Eigen::Vector3d(i, j, k)) / n);
    }
    return v;
  };
  const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) { mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}}); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      quad(vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0), vertex(i + 1, j, 0));
      quad(vertex(i, j, n), vertex(i + 1, j, n), vertex(i + 1, j + 1, n), vertex(i, j + 1, n));
      quad(vertex(i, 0, j), vertex(i + 1, 0, j), vertex(i + 1, 0, j + 1), vertex(i, 0, j + 1));
      quad(vertex(i, n, j), vertex(i, n, j + 1), vertex(i + 1, n, j + 1), vertex(i + 1, n, j));
      quad(vertex(0, i, j), vertex(0, i, j + 1), vertex(0, i + 1, j + 1), vertex(0, i + 1, j));
      quad(vertex(n, i, j), vertex(n, i + 1, j), vertex(n, i + 1, j + 1), vertex(n, i, j + 1));
    }
  }
  return mesh;
}

TEST(TypePoints, CornersOfABlockAreControls) {
  const TriangleMesh block = sharp_block(8, {0.1, 0.12, 0.2});
  ASSERT_TRUE(examine_topology(block).closed);
  const PointTyping typing = type_points(block);
  EXPECT_GE(typing.features, 8);
  const Bounds box = bounds(block.vertices);
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    int ends = 0;
    for (int axis = 0; axis < 3; ++axis) ends += block.vertices[v][axis] == box.low[axis] || block.vertices[v][axis] == box.high[axis];
    if (ends == 3) {
      EXPECT_EQ(typing.types[v], PointType::kControl);
    }
    // (b): the widest axis is z; its two end faces are the boundary.
    if (block.vertices[v].z() == box.low.z() || block.vertices[v].z() == box.high.z()) {
      EXPECT_EQ(typing.types[v], PointType::kControl);
    }
  }
}

// (e), by brute force: Floyd-Warshall distances along edges from every vertex to its nearest control.
TEST(TypePoints, NoVertexIsFarFromAControl) {
  for (const char* name : {"ball", "mug"}) {
    Random random(5);
    const TriangleMesh mesh = sample_family(name, random).mesh;
    const TypePointsOptions options;
    const auto typing = type_points(mesh, options);
    const std::size_t n = mesh.vertices.size();
    std::vector<double> distance(n, 1e9);
    for (std::size_t v = 0; v < n; ++v)
      if (typing.types[v] == PointType::kControl) distance[v] = 0;
    for (bool changed = true; changed;) {  // Bellman-Ford
      changed = false;
      for (const auto& triangle : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto a = static_cast<std::size_t>(triangle[k]), b = static_cast<std::size_t>(triangle[(k + 1) % 3]);
          const double through = distance[a] + (mesh.vertices[a] - mesh.vertices[b]).norm();
          if (through < distance[b]) {
            distance[b] = through;
            changed = true;
          }
        }
      }
    }
    for (const double d : distance) EXPECT_LE(d, options.fill_radius_edges * mean_edge_length(mesh) * (1 + 1e-12)) << name;
    const auto controls = std::count(typing.types.begin(), typing.types.end(), PointType::kControl);
    EXPECT_GT(controls, static_cast<std::ptrdiff_t>(n / 8)) << name;
    EXPECT_LT(controls, static_cast<std::ptrdiff_t>(2 * n / 3)) << name;
  }
}

TEST(TypePoints, ManualLayerWins) {
  const std::vector<PointType> automatic{PointType::kControl, PointType::kRegular, PointType::kControl};
  EXPECT_EQ(with_manual_types(automatic, {}), automatic);
  EXPECT_EQ(with_manual_types(automatic, {PointType::kRegular, std::nullopt, std::nullopt}),
            (std::vector<PointType>{PointType::kRegular, PointType::kRegular, PointType::kControl}));
}

// A block rests on three pairs of faces; the chance of each follows the solid angle that the face has from the middle.
TEST(StablePoses, BlockRestsOnItsFaces) {
  const auto poses = find_stable_poses(sharp_block(2, {0.1, 0.12, 0.2}), {.mirror_x = true, .mirror_y = true, .flip_z = true}, {.upright_share = 0.5});
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].name, "upright");
  EXPECT_DOUBLE_EQ(poses[0].probability, 0.5);
  EXPECT_EQ(poses[1].name, "lying_face");  // on the 0.12 x 0.2 face, whose normal is x
  EXPECT_EQ(poses[2].name, "lying_side");
  EXPECT_GT(poses[1].probability, poses[2].probability);
}

// Without a symmetry the six faces are six poses.
TEST(StablePoses, SymmetryMergesPoses) {
  const auto poses = find_stable_poses(sharp_block(2, {0.1, 0.12, 0.14}), {}, {.upright_share = 0.5});
  EXPECT_EQ(poses.size(), 6U);
}

TEST(StablePoses, FlatMeshesStandUpright) {
  const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}, {0, 2, 1}, {2, 3, 1}}};
  const auto poses = find_stable_poses(flat, {});
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].name, "upright");
}

}  // namespace
}  // namespace gfp
