#pragma once

#include <optional>

#include "gfp/core/time.hpp"

namespace gfp {

/// A device's clock as time of the session, strictly rising: over a device that was opened anew it goes on where it was, and where the device's own clock
/// goes back or stands still it goes on by a nanosecond, which ClockFit knows as a step. One thread at a time.
class SessionClock {
 public:
  void restart() { device_.reset(); }  ///< The device was opened anew: its clock has nothing to do with that of before.

  Nanoseconds stamp(Nanoseconds device) {
    const bool goes_on = device_ && device > *device_;
    session_ += goes_on ? device - *device_ : Nanoseconds(1);
    device_ = device;
    return session_;
  }

 private:
  std::optional<Nanoseconds> device_;
  Nanoseconds session_{-1};
};

}  // namespace gfp
