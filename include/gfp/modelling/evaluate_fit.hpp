#pragma once

#include <vector>

#include "gfp/memory/object_view.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

/// gamma of P28: a point 5 mm off counts half.
inline constexpr double kFitGammaPerM2 = 1.0 / (0.005 * 0.005);

/// What the view and its field say for and against a closed surface, whatever method made it. `mahalanobis` stays 0: only the method knows it.
/// @param states  one a vertex, or empty: gets kVertexObserved where a camera sees the vertex and it lies on data; bits of the
///                other kinds stay as they are.
FitEvidence evaluate_fit(const ObjectView& view, const std::vector<Eigen::Vector3d>& vertices_camera, const std::vector<Triangle>& triangles,
                         std::vector<std::uint8_t>& states);

}  // namespace gfp
