#pragma once

#include "gfp/cloud/stereo_to_depth.hpp"

namespace gfp {

/// Replaces the fractions of a pixel by what the grey values say: one step of Lucas and Kanade's method (IJCAI 1981) along the row, over 5 x 5 pixels (every
/// second row) of the same surface (disparities within 1 px), indifferent to an offset of brightness. Fractions of census costs are drawn towards
/// whole pixels; these are not. Where there is too little texture, or the step is longer than 0.75 px, the fraction stays as it was.
void refine_disparity(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right, DisparityImage& disparity);

}  // namespace gfp
