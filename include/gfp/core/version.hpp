#pragma once

#include <string_view>

namespace gfp {

std::string_view version();  ///< As in "0.1.0".

}  // namespace gfp
