#pragma once

#include <cstdint>
#include <vector>

#include "gfp/core/mesh.hpp"
#include "gfp/modelling/model_contour_paper.hpp"
#include "modelling/point_count.hpp"

namespace gfp {

/// What the contour starts from: a closed mesh among the scene's points, same frame, metres.
struct ContourStart {
  TriangleMesh mesh;
  std::vector<std::uint8_t> is_control;  ///< Per vertex.
  double search_m = 0;                   ///< How far a control looks for data.
};

struct ContourEnd {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::uint8_t> moved;  ///< Per vertex: off its first place.
  ContourTrace trace;
  bool converged = false;           ///< False: stopped at max_iterations.
};

/// Looks once where every control should go (density_rules.hpp), then steps there: in each iteration every control takes one step,
/// unless that raises its own energy (alpha E_cont + beta E_curv + E_ext), and the regular points follow (linear_law.hpp).
/// Stops when all controls are settled or frozen, when nothing moves 0.1 mm, or when the energy changes by less than 0.1 % three times.
ContourEnd run_paper_contour(const ContourStart& start, const PointCount& count, const PaperContourOptions& options, ContourDirections directions);

}  // namespace gfp
