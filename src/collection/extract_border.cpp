#include "collection/extract_border.hpp"

#include <algorithm>
#include <array>

#include "gfp/core/union_find.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr float kLevel = 0.29F;  ///< Of the blurred body: a flat sheet one voxel thick has 1/3 in its middle.
constexpr int kPad = 2;

/// Values at the middles of a box of voxels.
struct Grid {
  Vector3i low, size;
  double voxel_m = 0;
  std::vector<float> values;

  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(size.x()) + static_cast<std::size_t>(i);
  }
  Vector3d middle(const Vector3i& cell) const { return voxel_m * ((low + cell).cast<double>() + Vector3d::Constant(0.5)); }
};

Grid occupancy(const VoxelSolid& solid) {
  int first = 1 << 30, last = -(1 << 30);
  for (const auto& run : solid.runs) {
    first = std::min(first, run.first);
    last = std::max(last, run.last);
  }
  Grid grid{Vector3i(first - kPad, solid.low.y() - kPad, solid.low.z() - kPad), Vector3i(last - first + 2 * kPad, solid.size.y() + 2 * kPad, solid.size.z() + 2 * kPad), solid.voxel_m, {}};
  grid.values.assign(static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(grid.size.z()), 0.0F);
  for (int k = 0; k < solid.size.z(); ++k)
    for (int j = 0; j < solid.size.y(); ++j) {
      const auto row = static_cast<std::size_t>(k * solid.size.y() + j);
      for (auto r = solid.offsets[row]; r < solid.offsets[row + 1]; ++r) {
        const auto& run = solid.runs[static_cast<std::size_t>(r)];
        std::fill_n(&grid.values[grid.index(run.first - grid.low.x(), j + kPad, k + kPad)], run.last - run.first, 1.0F);
      }
    }
  return grid;
}

/// The mean of three neighbours along every axis.
void blur(Grid& grid) {
  const std::array<std::size_t, 3> steps{1, static_cast<std::size_t>(grid.size.x()), static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y())};
  std::vector<float> before;
  for (const std::size_t step : steps) {
    before = grid.values;
    for (std::size_t at = step; at + step < before.size(); ++at) grid.values[at] = (before[at - step] + before[at] + before[at + step]) * (1.0F / 3.0F);
  }
}

/// Marching tetrahedra: six a cube, all around its long diagonal, so that neighbours agree on every face and the surface is manifold.
/// Every edge goes from a corner of a cell (its low end) in one of seven directions, which names its vertex; two layers are kept.
class Extraction {
 public:
  explicit Extraction(const Grid& grid) : grid_(grid), layer_(7 * static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y())) {
    for (auto& ids : ids_) ids.assign(layer_, -1);
  }

  TriangleMesh run() {
    for (int k = 0; k + 1 < grid_.size.z(); ++k) {
      std::swap(ids_[0], ids_[1]);
      std::fill(ids_[1].begin(), ids_[1].end(), -1);
      for (int j = 0; j + 1 < grid_.size.y(); ++j)
        for (int i = 0; i + 1 < grid_.size.x(); ++i) march({i, j, k});
    }
    return std::move(mesh_);
  }

 private:
  void march(const Vector3i& cell) {
    static constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    cell_ = cell;
    inside_ = 0;
    for (int c = 0; c < 8; ++c) {
      values_[c] = grid_.values[grid_.index(cell.x() + (c & 1), cell.y() + (c >> 1 & 1), cell.z() + (c >> 2))];
      if (values_[c] > kLevel) inside_ |= 1 << c;
    }
    if (inside_ == 0 || inside_ == 255) return;
    for (const auto& tetrahedron : kTetrahedra) cut(tetrahedron);
  }

  void cut(const int (&tetrahedron)[4]) {
    int in[4], out[4], ins = 0, outs = 0;
    for (const int corner : tetrahedron) ((inside_ >> corner & 1) != 0 ? in[ins++] : out[outs++]) = corner;
    if (ins == 1) add(vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[0], out[2]), in[0]);
    if (ins == 3) add(vertex(in[0], out[0]), vertex(in[1], out[0]), vertex(in[2], out[0]), in[0]);
    if (ins == 2) {
      add(vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[1], out[0]), in[0]);
      add(vertex(in[1], out[0]), vertex(in[0], out[1]), vertex(in[1], out[1]), in[1]);
    }
  }

  Vector3d corner(int c) const { return grid_.middle(cell_ + Vector3i(c & 1, c >> 1 & 1, c >> 2)); }

  std::int32_t vertex(int inside, int outside) {
    const int low = inside & outside, direction = inside ^ outside;  // of a tetrahedron's two corners, one holds the other's bits
    const auto column = static_cast<std::size_t>(cell_.y() + (low >> 1 & 1)) * static_cast<std::size_t>(grid_.size.x()) + static_cast<std::size_t>(cell_.x() + (low & 1));
    std::int32_t& id = ids_[low >> 2][7 * column + static_cast<std::size_t>(direction - 1)];
    if (id < 0) {
      id = static_cast<std::int32_t>(mesh_.vertices.size());
      const double a = static_cast<double>(values_[inside]), b = static_cast<double>(values_[outside]);
      const double share = std::clamp((a - static_cast<double>(kLevel)) / (a - b), 0.05, 0.95);
      mesh_.vertices.push_back((1 - share) * corner(inside) + share * corner(outside));
    }
    return id;
  }

  /// Turned so that its normal points away from the inside corner.
  void add(std::int32_t a, std::int32_t b, std::int32_t c, int inside) {
    const auto point = [&](std::int32_t v) -> const Vector3d& { return mesh_.vertices[static_cast<std::size_t>(v)]; };
    const Vector3d normal = (point(b) - point(a)).cross(point(c) - point(a));
    if (normal.dot(point(a) - corner(inside)) >= 0) mesh_.triangles.push_back({a, b, c});
    else mesh_.triangles.push_back({a, c, b});
  }

  const Grid& grid_;
  std::size_t layer_;
  std::vector<std::int32_t> ids_[2];
  Vector3i cell_ = Vector3i::Zero();
  float values_[8] = {};
  int inside_ = 0;
  TriangleMesh mesh_;
};

/// The component with most triangles.
TriangleMesh largest_component(const TriangleMesh& mesh) {
  UnionFind sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) sets.join(t[0], t[1]), sets.join(t[0], t[2]);
  std::vector<std::int32_t> sizes(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) ++sizes[static_cast<std::size_t>(sets.root(t[0]))];
  const auto most = static_cast<std::int32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  TriangleMesh kept;
  std::vector<std::int32_t> place(mesh.vertices.size(), -1);
  for (Triangle t : mesh.triangles) {
    if (sets.root(t[0]) != most) continue;
    for (std::int32_t& v : t) {
      std::int32_t& at = place[static_cast<std::size_t>(v)];
      if (at < 0) {
        at = static_cast<std::int32_t>(kept.vertices.size());
        kept.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = at;
    }
    kept.triangles.push_back(t);
  }
  return kept;
}

}  // namespace

TriangleMesh extract_border(const VoxelSolid& solid) {
  if (solid.runs.empty()) return {};
  Grid grid = occupancy(solid);
  blur(grid);
  const TriangleMesh border = Extraction(grid).run();
  return border.triangles.empty() ? border : largest_component(border);
}

}  // namespace gfp
