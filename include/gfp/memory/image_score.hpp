#pragma once

#include "gfp/memory/observed_tile.hpp"

namespace gfp {

/// How a rendered surface and the readings disagree, pixel by pixel; the currency in which placements, methods and classes compete.
struct ImageScore {
  double cost = 0;                  ///< Mean over object cells of the capped negative log likelihood, free-space violations added.
  double explained = 0;             ///< Share of object cells that the surface covers within 3 sigma.
  double free_space_violation = 0;  ///< Share of the surface's visible cells that stand where the sensor saw past.
  double silhouette_iou = 0;        ///< Of silhouette and mask, cells without a reading or behind an occluder left out.
  double rms_m = 0;                 ///< Point-to-plane over covered object cells within 3 sigma + 10 mm.
};

/// Signed distance (metres) of the rendered surface behind the observed tangent plane at an object cell that both have.
inline double plane_distance(const ObservedTile& observed, const DepthTile& rendered, int cell) {
  const auto c = static_cast<std::size_t>(cell);
  return (static_cast<double>(rendered.depth[c]) - static_cast<double>(observed.depth[c])) * static_cast<double>(observed.cosine[c]);
}

/// Did the sensor see past the rendered surface at this cell? Cells without a reading say nothing.
bool in_free_space(const ObservedTile& observed, const DepthTile& rendered, int cell);

/// Independent readings that an object's pixels are worth, for noise and misfit are correlated: what a score weighs in nats.
inline constexpr double kUnexplainedCost = 4.5;                      ///< Negative log likelihood of a pixel that is not explained: 3 sigma.
inline constexpr double kMostlyUnexplained = 0.5 * kUnexplainedCost;  ///< A mean cost: a fit that is worse says nothing of what the thing is.

inline constexpr double kScorePixels = 60;

inline constexpr double kModelSigmaM = 0.003;  ///< What even a good model does not follow, metres.

/// `rendered` must have the grid of `observed`. A larger `model_sigma_m` tells apart models that are still far off.
ImageScore image_score(const ObservedTile& observed, const DepthTile& rendered, double model_sigma_m = kModelSigmaM);

}  // namespace gfp
