#pragma once

#include <vector>

#include "gfp/core/image.hpp"
#include "gfp/evaluation/cases.hpp"
#include "gfp/modelling/fitted_model.hpp"

namespace gfp {

inline constexpr int kPictureTile_px = 132;

/// One row of square tiles for one case: the depth image around the object (its pixels tinted), the true object from the
/// camera and from behind, then for every fit: its mesh (blue observed, orange inferred), and its signed error from the camera
/// and from behind (red outside the true surface, blue inside, white on it; full colour at 10 mm).
Image<Rgb8> draw_case(const EvaluationCase& shown, const std::vector<FittedModel>& fits);

}  // namespace gfp
