#pragma once

#include <chrono>

#include "gfp/core/time.hpp"

namespace gfp {

/// Gives sources that are not driven by a device their rhythm. One thread at a time.
class Pacer {
 public:
  void restart() { started_ = false; }  ///< The next wait starts the clock anew.

  /// Waits until `due` of the source's own time, counted from the first call's `due`, but at most `timeout`.
  /// False: it is not due yet (a timeout); ask again. A source that fell behind by more than 100 ms does not hurry to
  /// catch up: its clock is set anew.
  bool wait_until_due(Nanoseconds due, std::chrono::milliseconds timeout);

 private:
  bool started_ = false;
  Nanoseconds offset_{};  ///< Host monotonic time minus the source's time.
};

}  // namespace gfp
