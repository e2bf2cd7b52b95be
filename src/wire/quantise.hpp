#pragma once

#include <span>
#include <string>

namespace gfp::wire {

/// `bytes` become the int16 (xyz[i] - origin[i % 3]) / scale to the nearest, ties up, within +-32767.
void quantise_points(std::span<const double> xyz, const double origin[3], double scale, std::string& bytes);

/// `bytes` become the uint16 values[i] / scale to the nearest, ties up, within [0, 65535].
void quantise_lengths(std::span<const float> values, double scale, std::string& bytes);

/// 0 where all are negative, or there are none.
float largest_of(std::span<const float> values);

}  // namespace gfp::wire
