#pragma once

#include <condition_variable>
#include <cstdint>
#include <optional>
#include <stop_token>

#include "gfp/core/mutex.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

/// The knobs of a replay, for whoever shows or steers it: the player asks, anybody turns. Safe from any thread.
class ReplayControl {
 public:
  struct State {
    bool paused = false;
    double speed = 1;          ///< 0: as fast as frames are taken.
    Nanoseconds begin{};       ///< When the first frame was recorded, CLOCK_REALTIME.
    Nanoseconds position{};    ///< Of the last frame, or of the seek after it, since the beginning.
    Nanoseconds duration{};    ///< From the first frame to the last.
    std::uint64_t frames = 0;  ///< Played so far.
    bool ended = false;
  };

  void pause();
  void resume();
  void step();                        ///< One more frame while paused.
  void set_speed(double speed);       ///< At least 0.
  void seek(Nanoseconds position);    ///< The next frame is the first one at or after it.
  void hold_at_end();                 ///< From now on the recording waits at its end for a seek, where it would be over.
  State state() const;

  // The player's side.
  void begin(Nanoseconds recorded_at, Nanoseconds duration, double speed);
  void played(Nanoseconds position, bool ended);
  std::optional<Nanoseconds> take_seek();
  /// Waits while paused, at most so long. True: go on.
  bool wait_until_running(std::chrono::milliseconds timeout);
  bool holds_at_end() const;
  bool wait_for_seek(std::chrono::milliseconds timeout);  ///< At most so long. True: take_seek() has one.

 private:
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  State state_ GFP_GUARDED_BY(mutex_);
  std::optional<Nanoseconds> seek_ GFP_GUARDED_BY(mutex_);
  int steps_ GFP_GUARDED_BY(mutex_) = 0;
  bool holds_at_end_ GFP_GUARDED_BY(mutex_) = false;
};

}  // namespace gfp
