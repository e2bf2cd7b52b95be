#include "gfp/frame/backoff.hpp"

#include <algorithm>
#include <chrono>

#include "gfp/core/mutex.hpp"

namespace gfp {

void Backoff::reset() { pause_s_ = std::min(options_.initial_s, options_.max_s); }

double Backoff::next_s() {
  const double pause = pause_s_;
  pause_s_ = std::min(2 * pause_s_, options_.max_s);
  return pause;
}

bool sleep_for(double seconds, const std::stop_token& stop) {
  Mutex mutex;
  std::condition_variable_any never;
  MutexLock lock(mutex);
  never.wait_for(lock, stop, std::chrono::duration<double>(seconds), [] { return false; });
  return !stop.stop_requested();
}

}  // namespace gfp
