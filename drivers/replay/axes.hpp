#pragma once

#include <array>
#include <string>
#include <string_view>

#include "gfp/core/error.hpp"

namespace gfp {

/// Which axes of a file are the optical right, down and forward (DESIGN, conventions). Written as three signed letters in
/// that order: `xyz` is optical already, `x-y-z` has y up and looks along -z (OpenGL), `-y-zx` looks along x with z up (ROS body).
struct Axes {
  std::array<int, 3> index{0, 1, 2};  ///< File axis of right, down, forward: a permutation of 0, 1, 2.
  std::array<int, 3> sign{1, 1, 1};   ///< +1 or -1.

  /// A file whose axes are left-handed cannot be turned into the optical frame, only mirrored into it.
  bool left_handed() const;
  friend bool operator==(const Axes&, const Axes&) = default;
};

/// Errors: kInvalidArgument naming the text and the form expected.
Result<Axes> parse_axes(std::string_view text);
std::string to_string(const Axes& axes);

}  // namespace gfp
