#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// Exact distances to a triangle mesh and crossings with it, through a bounding-volume hierarchy.
/// Immutable once built; safe from any thread. An empty mesh is infinitely far from everything.
/// Cost: build O(T log T), about 0.4 ms for 1200 triangles; a query about 1-3 us.
class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(const TriangleMesh& mesh);

  struct Closest {
    double distance_m = std::numeric_limits<double>::infinity();
    std::int32_t triangle = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  /// The nearest surface point; nothing (triangle = -1) where all is farther than `reach_m`.
  Closest closest(const Eigen::Vector3d& point, double reach_m = std::numeric_limits<double>::infinity()) const;

  /// Whether the open segment from `from` to `to` crosses the surface.
  bool blocks(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Signed distance along `direction` (unit) to the nearest crossing, ahead or behind, that faces the same way
  /// (its triangle's normal makes an acute angle with `direction`); nothing where there is none within `reach_m`.
  std::optional<double> crossing_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double reach_m) const;

 private:
  struct Node {
    Eigen::Vector3d low, high;
    std::int32_t first = 0;  ///< Leaf: first of its triangles. Inner node: its right child (the left one follows it).
    std::int32_t count = 0;  ///< Triangles of a leaf; 0 for an inner node.
  };
  struct Packed {
    Eigen::Vector3d a, b, c;
    std::int32_t index;
  };
  void build(std::int32_t first, std::int32_t count);

  std::vector<Node> nodes_;
  std::vector<Packed> triangles_;
};

/// The point of triangle (a, b, c) nearest to `point` (exact, degenerate triangles included).
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace gfp
