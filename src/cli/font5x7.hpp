#pragma once

#include <array>
#include <cstdint>

namespace gfp {

/// Seven rows from the top; bit 4 is the leftmost of five dots.
using Glyph = std::array<std::uint8_t, 7>;

/// Letters come as capitals; what the font does not have is a hollow box.
const Glyph& glyph(char letter);

}  // namespace gfp
