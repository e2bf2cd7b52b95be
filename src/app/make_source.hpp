#pragma once

#include <memory>

#include "config/daemon_options.hpp"
#include "gfp/core/error.hpp"
#include "gfp/frame/frame_source.hpp"

namespace gfp {

/// The driver registry: the source that a sensor's configuration describes, not opened yet.
/// Errors: kUnsupported (a driver that this build has not), kInvalidArgument, kNotFound and others of its camera file or input.
/// `isolation: process` makes a source that runs this program's driver process: gfpd only.
Result<std::unique_ptr<FrameSource>> make_source(const SensorConfig& sensor);

}  // namespace gfp
