#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "grasp/box.hpp"

namespace gfp {

/// Where a ray crosses a surface.
struct Crossing {
  double distance_m = 0;
  std::int32_t triangle = -1;
  bool entering = false;  ///< The ray goes against the triangle's normal: from outside to inside.
};

/// Bounding-volume hierarchy over a mesh's triangles: four children a node, four triangles a leaf, both laid out for vector
/// instructions. Immutable; safe from any thread.
/// Cost: about 0.1 ms to build for 1200 triangles, well under 1 us a query.
class TriangleBvh {
 public:
  TriangleBvh(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Triangle>& triangles);

  /// All crossings of origin + t direction (unit), 0 < t < limit, by distance.
  void crossings(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double limit_m, std::vector<Crossing>& out) const;
  /// Whether any triangle shares a point with the box (surfaces only: a box deep inside a solid meets nothing).
  bool meets(const OrientedBox& box) const;
  /// Exact distance of the nearest triangle to the box, at most `limit_m`.
  double distance(const OrientedBox& box, double limit_m) const;
  /// Triangles whose bounds come near the box; all that meet it are among them.
  void gather(const OrientedBox& box, std::vector<std::int32_t>& triangles) const;

  /// Four boxes side by side, world axes. An empty lane has a negative extent and no child.
  struct Node {
    double centre[3][4], extent[3][4];
    std::int32_t child[4];  ///< >= 0: a node; < 0: leaf ~child; kNone.
  };
  /// Four triangles side by side: first corner and the edges from it.
  struct Leaf {
    double corner[3][4], edge1[3][4], edge2[3][4];
    std::int32_t triangle[4];
    int count;
  };

 private:
  static constexpr std::int32_t kNone = INT32_MAX;
  struct Build;

  std::int32_t add_node(Build& build, std::int32_t first, std::int32_t last);
  std::int32_t add_leaf(const Build& build, std::int32_t first, std::int32_t last);
  /// Visits the leaves below all lanes that `measure(node, lane values)` gives at most `limit()`; `visit` returns true to stop.
  template <class Measure, class Limit, class Visit>
  void walk(const Measure& measure, const Limit& limit, const Visit& visit) const;

  std::vector<Node> nodes_;  // the root first, if there is any triangle
  std::vector<Leaf> leaves_;
};

}  // namespace gfp
