#pragma once

#include <filesystem>
#include <memory>

#include "config/daemon_options.hpp"
#include "gfp/core/error.hpp"
#include "gfp/frame/frame_source.hpp"

namespace gfp {

/// The sensor's driver in a process of its own (`gfpd --driver-child`): what crashes or hangs inside a vendor's library ends that process, not this one.
///
///     driver process: source -> FrameRing (shared memory), a packet a frame -> this process: grab() copies the frame out
///
/// grab() errors besides the driver's own: kDeviceLost, beginning with `crash:` (the process ended) or `hang:` (it said nothing for three frame periods
/// and half a second, or `source.hang_s`, and was killed). run_source() then opens anew, which starts a new process. open() errors: the driver's, kIo.
/// `program`: gfpd; empty: this one. `info`: what the source says of itself.
std::unique_ptr<FrameSource> make_isolated_source(SensorConfig sensor, SourceInfo info, const std::filesystem::path& program = {});

}  // namespace gfp
