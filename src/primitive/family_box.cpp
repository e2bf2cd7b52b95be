// Box: any aspect, edges slightly rounded, faces slightly swollen or dented.
#include <map>

#include "primitive/curves.hpp"
#include "primitive/family_shape.hpp"

namespace gfp {
namespace {

constexpr int kCells = 10;  // along every edge; the first and last one round it

using Lattice = std::array<int, 3>;

/// Vertices of the cube's surface lattice [0, kCells]^3 and its triangles, diagonals mirrored about the middle planes.
struct CubeSurface {
  std::vector<Lattice> vertices;
  std::vector<Triangle> triangles;
};

CubeSurface cube_surface() {
  CubeSurface cube;
  std::map<Lattice, std::int32_t> index;
  const auto vertex = [&](const Lattice& at) {
    const auto [entry, fresh] = index.try_emplace(at, static_cast<std::int32_t>(cube.vertices.size()));
    if (fresh) cube.vertices.push_back(at);
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;  // u x v = axis
    for (const int side : {0, kCells}) {
      for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
          const auto corner = [&](int di, int dj) {
            Lattice at{};
            at[axis] = side;
            at[u] = i + di;
            at[v] = j + dj;
            return vertex(at);
          };
          std::int32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == 0) std::swap(b, d);
          if ((2 * i < kCells) == (2 * j < kCells)) cube.triangles.insert(cube.triangles.end(), {{a, b, c}, {a, c, d}});
          else cube.triangles.insert(cube.triangles.end(), {{b, c, d}, {b, d, a}});
        }
      }
    }
  }
  return cube;
}

}  // namespace

FamilyShape make_box(ParameterDraw& draw) {
  // Breadth (x), width (y) and height from matchboxes to cereal packets; x is not the longer one: boxes turn anyway.
  const double mean = draw.log_range(0.038, 0.19);
  const Eigen::Vector3d half = 0.5 * mean * Eigen::Vector3d(draw.log_range(0.5, 2.0), draw.log_range(0.5, 2.0), draw.log_range(0.38, 2.0));
  const double edge = half.minCoeff() * draw.log_range(0.03, 0.2);
  const Eigen::Vector3d swell(draw.range(-0.03, 0.05), draw.range(-0.03, 0.05), draw.range(-0.015, 0.04));
  const double taper_x = draw.range(-0.05, 0.05), taper_y = draw.range(-0.05, 0.05);

  const CubeSurface cube = cube_surface();
  FamilyShape box;
  for (const auto& lattice : cube.vertices) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const int i = lattice[static_cast<std::size_t>(axis)], centred = 2 * i - kCells;  // odd in the lattice: exact mirror pairs
      const double inner = (half[axis] - edge) * centred / (kCells - 2);
      p[axis] = i == 0 ? -half[axis] : i == kCells ? half[axis] : inner;
    }
    const Eigen::Vector3d core = p.cwiseMax(edge * Eigen::Vector3d::Ones() - half).cwiseMin(half - edge * Eigen::Vector3d::Ones());
    p = core + edge * (p - core).normalized();
    const Eigen::Vector3d q = p.cwiseQuotient(half);
    const Eigen::Vector3d bow = Eigen::Vector3d::Ones() - q.cwiseProduct(q).cwiseMin(1.0);
    // Faces bow in the middle; the top and the base only inwards, so that a box still stands on its edges.
    p.x() *= (1 + swell.x() * bow.y() * bow.z()) * (1 + taper_x * q.z());
    p.y() *= (1 + swell.y() * bow.x() * bow.z()) * (1 + taper_y * q.z());
    p.z() *= q.z() < 0 ? 1 - std::abs(swell.z()) * 0.3 * bow.x() * bow.y() : 1 + swell.z() * bow.x() * bow.y();
    box.mesh.vertices.push_back(p + half.z() * Eigen::Vector3d::UnitZ());
    box.parts.push_back(lattice[2] == 0 ? Part::kBase : Part::kBody);
  }
  box.mesh.triangles = cube.triangles;
  box.filled.assign(cube.triangles.size(), true);
  box.reference_size_m = 2 * half;
  return box;
}

}  // namespace gfp
