#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"

namespace gfp {

/// The paper's linear law (eq. 7, P26) in its sensible form: a control displaced by D drags what lies around it on the surface,
///     p' = p + D (1 - d / d_max),   d_max = max(|D|, 2 l),
/// d geodesic from the control at rest, l the mean edge. Where several controls reach a point, their pulls are added and divided by the
/// sum of the weights (1 - d / d_max) where that exceeds 1: no order matters, and between equal displacements nothing dips.
class LinearLaw {
 public:
  /// @param reach_m  the greatest |D| that will occur. Cost: a bounded Dijkstra search a control.
  LinearLaw(const TriangleMesh& rest, const std::vector<std::uint8_t>& is_control, double edge_m, double reach_m);

  /// Sets the displacements of the regular points from those of the controls.
  void drag(std::vector<Eigen::Vector3d>& displacements) const;

 private:
  struct Pull {
    std::int32_t regular, control;
    double distance_m;
  };
  std::vector<Pull> pulls_;  ///< By regular point.
  double edge_m_;
};

/// Distances along the edges from `source` to the vertices nearer than `reach_m`; ascending by distance, then index.
struct Reached {
  std::int32_t vertex;
  double distance_m;
};
std::vector<Reached> edge_distances(const TriangleMesh& mesh, const VertexAdjacency& adjacency, std::int32_t source, double reach_m);

}  // namespace gfp
