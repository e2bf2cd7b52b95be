#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <optional>

#include "gfp/core/mutex.hpp"
#include "gfp/core/time.hpp"

namespace gfp {

/// The knobs of a replay, for whoever shows or steers it: the players ask, anybody turns. Several players, each with the recording of one sensor, share one
/// time line, that of recording. Safe from any thread.
class ReplayControl {
 public:
  struct State {
    bool paused = false;
    double speed = 1;          ///< 0: as fast as frames are taken.
    Nanoseconds begin{};       ///< When the first frame of all was recorded, CLOCK_REALTIME.
    Nanoseconds position{};    ///< Of the last frame, or of the seek after it, since the beginning.
    Nanoseconds duration{};    ///< From the first frame of all to the last.
    std::uint64_t frames = 0;  ///< Played so far.
    bool ended = false;        ///< All have come to their ends.
  };

  void pause();
  void resume();
  void step();                        ///< One more frame of every sensor while paused.
  void set_speed(double speed);       ///< At least 0.
  void seek(Nanoseconds position);    ///< The next frame of every sensor is the first one at or after it.
  void hold_at_end();                 ///< From now on the recording waits at its end for a seek, where it would be over.
  State state() const;

  // The players' side. All times are of recording, CLOCK_REALTIME.
  using Player = std::uint64_t;
  struct Span {
    Nanoseconds begin, end;
  };
  struct Seek {
    Nanoseconds target;
    Nanoseconds offset;  ///< Of all seeks so far: added to recorded stamps, these go on as the play does, not as the person jumps.
  };

  Player join(Nanoseconds first, Nanoseconds last, double speed);  ///< All join before the first one plays; the first one's speed holds.
  void leave(Player player);
  Span span() const;  ///< Of all players' recordings.
  void played(Player player, Nanoseconds recorded_at, bool ended);
  std::optional<Seek> take_seek(Player player);
  /// Waits while paused, at most so long. True: go on.
  bool wait_until_running(Player player, std::chrono::milliseconds timeout);
  bool holds_at_end() const;
  bool wait_for_seek(Player player, std::chrono::milliseconds timeout);  ///< At most so long. True: take_seek() has one.

 private:
  struct Playing {
    Nanoseconds first{}, last{};
    std::optional<Nanoseconds> position;  ///< Of the last frame or seek.
    int steps = 0;
    bool is_to_seek = false, ended = false;
  };
  Span span_locked() const GFP_REQUIRES(mutex_);
  Nanoseconds position_locked() const GFP_REQUIRES(mutex_);

  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::map<Player, Playing> players_ GFP_GUARDED_BY(mutex_);
  Player next_player_ GFP_GUARDED_BY(mutex_) = 0;
  Seek seek_ GFP_GUARDED_BY(mutex_){};
  double speed_ GFP_GUARDED_BY(mutex_) = 1;
  std::uint64_t frames_ GFP_GUARDED_BY(mutex_) = 0;
  bool is_paused_ GFP_GUARDED_BY(mutex_) = false, holds_at_end_ GFP_GUARDED_BY(mutex_) = false;
};

/// Between a frame and the one that is shown after a jump or from the beginning again: one at 30 Hz.
inline constexpr Nanoseconds kAfterJump{33'333'333};

}  // namespace gfp
