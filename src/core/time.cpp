#include "gfp/core/time.hpp"

namespace gfp {

Nanoseconds monotonic_now() { return std::chrono::steady_clock::now().time_since_epoch(); }
Nanoseconds realtime_now() { return std::chrono::system_clock::now().time_since_epoch(); }

}  // namespace gfp
