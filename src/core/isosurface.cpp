#include "gfp/core/isosurface.hpp"

#include <algorithm>

#include "gfp/core/union_find.hpp"

namespace gfp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Marching tetrahedra: six a cube, all around its long diagonal, so that neighbours agree on every face and the surface is manifold.
/// Every edge goes from a corner of a cell (its low end) in one of seven directions, which names its vertex; two layers are kept.
class Extraction {
 public:
  Extraction(const ScalarGrid& grid, float level) : grid_(grid), level_(level), layer_(7 * static_cast<std::size_t>(grid.size.x()) * static_cast<std::size_t>(grid.size.y())) {
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
      if (values_[c] > level_) inside_ |= 1 << c;
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

  Vector3d corner(int c) const { return grid_.place(cell_ + Vector3i(c & 1, c >> 1 & 1, c >> 2)); }

  std::int32_t vertex(int inside, int outside) {
    const int low = inside & outside, direction = inside ^ outside;  // of a tetrahedron's two corners, one holds the other's bits
    const auto column = static_cast<std::size_t>(cell_.y() + (low >> 1 & 1)) * static_cast<std::size_t>(grid_.size.x()) + static_cast<std::size_t>(cell_.x() + (low & 1));
    std::int32_t& id = ids_[low >> 2][7 * column + static_cast<std::size_t>(direction - 1)];
    if (id < 0) {
      id = static_cast<std::int32_t>(mesh_.vertices.size());
      const double a = static_cast<double>(values_[inside]), b = static_cast<double>(values_[outside]);
      const double share = std::clamp((a - static_cast<double>(level_)) / (a - b), 0.05, 0.95);
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

  const ScalarGrid& grid_;
  float level_;
  std::size_t layer_;
  std::vector<std::int32_t> ids_[2];
  Vector3i cell_ = Vector3i::Zero();
  float values_[8] = {};
  int inside_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh isosurface(const ScalarGrid& grid, float level) { return Extraction(grid, level).run(); }

TriangleMesh largest_component(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return {};
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

}  // namespace gfp
