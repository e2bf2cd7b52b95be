#pragma once

#include "config/daemon_options.hpp"
#include "gfp/core/error.hpp"
#include "publish/publisher.hpp"

namespace gfp {

/// Sends spdlog's default logger to standard error or the file of `options`, and to nowhere else yet. Errors: kIo (the file).
Result<void> start_logging(const LogOptions& options);

/// From now on, what is logged from `info` on also goes to /gfp/log/. Until publish_log_to(nullptr), which must come before
/// the publisher's end.
void publish_log_to(Publisher* publisher);

}  // namespace gfp
