#pragma once

#include <ctime>

namespace gfp {

/// CPU time of the calling thread: other programs on the machine do not count.
inline double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace gfp
