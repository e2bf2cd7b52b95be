#include "replay/axes.hpp"

#include <fmt/format.h>

namespace gfp {

bool Axes::left_handed() const {
  const bool even = index[1] == (index[0] + 1) % 3;  // a cyclic permutation keeps the hand
  return (even ? 1 : -1) * sign[0] * sign[1] * sign[2] < 0;
}

Result<Axes> parse_axes(std::string_view text) {
  Axes axes;
  std::array<bool, 3> used{};
  std::string_view rest = text;
  bool valid = true;
  for (std::size_t i = 0; i < 3 && valid; ++i) {
    axes.sign[i] = rest.starts_with('-') ? -1 : 1;
    if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
    const int letter = rest.empty() ? -1 : rest.front() - 'x';
    valid = letter >= 0 && letter < 3 && !used[static_cast<std::size_t>(letter)];
    if (!valid) break;
    used[static_cast<std::size_t>(letter)] = true;
    axes.index[i] = letter;
    rest.remove_prefix(1);
  }
  if (!valid || !rest.empty())
    return failure(ErrorCode::kInvalidArgument,
                   fmt::format("axes = '{}', expected x, y and z once each with an optional sign, as the file's right, down "
                               "and forward (as in xyz or x-y-z)", text.substr(0, 40)));
  return axes;
}

std::string to_string(const Axes& axes) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    if (axes.sign[i] < 0) text += '-';
    text += static_cast<char>('x' + axes.index[i]);
  }
  return text;
}

}  // namespace gfp
