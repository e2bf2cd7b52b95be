#include "gfp/memory/image_score.hpp"

#include <algorithm>
#include <cmath>

namespace gfp {
namespace {

constexpr double kFreeSpaceTolerance = 0.017;  ///< Edges waver and mixed pixels float by this much along the ray, metres.
constexpr double kSpillCost = 1.5 * kUnexplainedCost;      ///< A model in seen free space is worse than a bare pixel.
constexpr double kUnknownCost = 0.02 * kUnexplainedCost;    ///< Where nothing is known a model may be, but has no reason to spread.

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

bool in_free_space(const ObservedTile& observed, const DepthTile& rendered, int cell) {
  return observed.depth[at(cell)] > static_cast<double>(rendered.depth[at(cell)]) + kFreeSpaceTolerance;
}

ImageScore image_score(const ObservedTile& observed, const DepthTile& rendered, double model_sigma_m) {
  ImageScore score;
  double cost = 0, squares = 0;
  int explained = 0, near = 0, visible = 0, violating = 0, covered = 0;
  for (const int cell : observed.object_cells) {
    if (!rendered.hit(cell)) {
      cost += kUnexplainedCost;
      continue;
    }
    ++covered;
    ++visible;
    const double distance = plane_distance(observed, rendered, cell);
    const double sensor_sigma = static_cast<double>(observed.sigma_m[at(cell)]);
    const double variance = sensor_sigma * sensor_sigma + model_sigma_m * model_sigma_m;
    cost += std::min(0.5 * distance * distance / variance, kUnexplainedCost);
    explained += distance * distance < 9 * variance ? 1 : 0;
    if (std::abs(distance) < 3 * sensor_sigma + 0.010) {
      squares += distance * distance;
      ++near;
    }
  }
  int spilled = 0;
  for (int cell = 0; cell < observed.cells(); ++cell) {
    if (!rendered.hit(cell) || observed.evidence[at(cell)] == Evidence::kObject) continue;
    if (observed.depth[at(cell)] <= 0) {
      cost += kUnknownCost;
      continue;
    }
    ++visible;
    if (!in_free_space(observed, rendered, cell)) continue;
    cost += kSpillCost;
    ++violating;
    ++spilled;
  }
  const auto cells = static_cast<double>(std::max<std::size_t>(1, observed.object_cells.size()));
  score.cost = cost / cells;
  score.explained = explained / cells;
  score.free_space_violation = visible > 0 ? violating / static_cast<double>(visible) : 0;
  score.silhouette_iou = covered / (cells + spilled);
  score.rms_m = near > 0 ? std::sqrt(squares / near) : 0;
  return score;
}

}  // namespace gfp
