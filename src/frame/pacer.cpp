#include "gfp/frame/pacer.hpp"

#include <thread>

namespace gfp {

bool Pacer::wait_until_due(Nanoseconds due, std::chrono::milliseconds timeout) {
  const Nanoseconds now = monotonic_now();
  constexpr Nanoseconds kLag = std::chrono::milliseconds(100);
  if (!started_ || now - (due + offset_) > kLag) {
    offset_ = now - due;
    started_ = true;
  }
  const Nanoseconds remaining = due + offset_ - now;
  if (remaining > timeout) {
    std::this_thread::sleep_for(timeout);
    return false;
  }
  if (remaining > Nanoseconds::zero()) std::this_thread::sleep_for(remaining);
  return true;
}

}  // namespace gfp
