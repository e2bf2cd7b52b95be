#include "gfp/core/version.hpp"

namespace gfp {

std::string_view version() { return GFP_VERSION; }

}  // namespace gfp
