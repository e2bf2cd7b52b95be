#pragma once

#include <string_view>

namespace gfp {

/// Says `state` (as in `READY=1`, `WATCHDOG=1`, `STOPPING=1`) to the service manager that started us with Type=notify: a datagram
/// to $NOTIFY_SOCKET, the protocol of sd_notify(3). Does nothing where there is none; never blocks, never fails.
void tell_service_manager(std::string_view state);

/// `RELOADING=1` with the monotonic stamp that systemd wants beside it; `READY=1` ends it.
void tell_reloading();

}  // namespace gfp
