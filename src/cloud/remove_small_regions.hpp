#pragma once

#include <cstdint>

#include "gfp/core/image.hpp"

namespace gfp {

/// Sets the pixels of regions with fewer than `min_pixels` to 0. A region: pixels above 0, of which neighbours (left, right, above, below)
/// differ by at most `max_step`. Cost: about a millisecond at 640 x 480, by runs instead of pixels.
void remove_small_regions(Image<std::uint16_t>& image, int max_step, int min_pixels);

}  // namespace gfp
