#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>

#include "gfp/frame/backoff.hpp"
#include "gfp/frame/frame_health.hpp"
#include "gfp/frame/frame_source.hpp"
#include "gfp/frame/latest_slot.hpp"

namespace gfp {

enum class SourceState {
  kConnecting,  ///< Opened (or trying to), no frame yet.
  kStreaming,   ///< Frames arrive.
  kStalled,     ///< Open, but timeouts or corrupt frames only; recovers by itself with the next frame.
  kPaused,      ///< Somebody holds the recording; it is as it should be.
  kLost,        ///< Gone, or stuck for `stalls_before_reopen` grabs: reconnecting with back-off.
  kEnded,       ///< The recording came to its end.
  kFailed,      ///< Cannot work as configured (`last_error` says what to fix); not retried.
  kStopped,     ///< The owner asked for it.
};

std::string_view to_string(SourceState state);

/// What became of a source; counts are since run_source() began.
struct SourceStatus {
  SourceState state = SourceState::kConnecting;
  std::uint64_t frames = 0;          ///< Delivered into the slot.
  std::uint64_t timeouts = 0;        ///< Grabs that brought nothing in time.
  std::uint64_t corrupt_frames = 0;  ///< Frames that were damaged and left out.
  std::uint64_t reconnects = 0;      ///< Times that frames came again after the source had been lost.
  std::optional<Error> last_error;   ///< The latest of any kind; stays after recovery.
  std::string_view fault;            ///< What is wrong now, by a name of gfp::fault; empty: nothing.
  std::string_view clock_state = "free";  ///< As ClockFit says it.
};

struct SourceOptions {
  double grab_timeout_s = 0.5;    ///< Also bounds how long stopping takes.
  int stalls_before_reopen = 6;   ///< So many fruitless grabs in a row mean a stuck device: it is closed and opened again.
  double hang_s = 0;              ///< With `isolation: process`: silent for so long, the process hangs; 0: three frame periods and half a second.
  BackoffOptions reconnect;       ///< Of what fails again and again; a device that is not there at all is looked for every second at least.
  FrameHealthOptions health;
};

template <class Visitor>
void visit_fields(SourceOptions& o, Visitor&& field) {
  field("grab_timeout_s", o.grab_timeout_s, 0.001, 60.0);
  field("stalls_before_reopen", o.stalls_before_reopen, 1, 1'000'000);
  field("hang_s", o.hang_s, 0.0, 60.0);
  field.section("reconnect", o.reconnect);
  field.section("health", o.health);
}

/// The life of one source, on the caller's thread: opens, grabs and hands over until `stop` is requested, the stream ends
/// or its configuration proves wrong; reopens a lost or stuck device with back-off. Closes the source and the slot at the end.
///
/// Frames that FrameHealth refuses count as corrupt and are not handed over.
///
/// The sensor stamps of what is no recording become host time (ClockFit), so that the frames of several sensors can be ordered.
///
/// `on_change` is called on this thread once per change of state, fault or clock state (not per frame), after the status was updated.
/// grab(): kTimeout and damage of one frame (any other code) are counted, kDeviceLost reopens, kEndOfStream ends; kPaused is neither
/// counted nor a stall.
/// open(): kInvalidArgument, kUnsupported, kCorruptData and kTooLarge end as kFailed; anything else is tried again.
SourceStatus run_source(FrameSource& source, LatestSlot<FramePtr>& out, const SourceOptions& options,
                        const std::stop_token& stop, const std::function<void(const SourceStatus&)>& on_change = {});

}  // namespace gfp
