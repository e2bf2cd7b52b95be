#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/soak_ledger.hpp"

namespace gfp::test {

/// 20 subscribers and 4 viewers that are stuck beside a good subscriber, for so long, against half a minute without them. Even trials: our
/// own client over ipc, stopped by SIGSTOP; odd ones: plain ZeroMQ over tcp.
Trial stuck_trial(std::uint64_t number, double seconds);
/// What a process of the above does: listens to everything. `plain`: without what our client does beyond ZeroMQ's defaults.
void listen_for_ever(const std::vector<std::string>& endpoints, bool plain);

/// A minute of 1000 connects a second, most of them half-open or gone at once, and 20,000 subscriptions.
Trial flood_trial(std::uint64_t number);

/// A subscriber that comes at any time ends with the publisher's state, while objects come, change and go.
Trial join_trial(std::uint64_t number);

/// One client without the right key, of every kind in turn, on every socket.
Trial key_trial(std::uint64_t number);

/// SIGTERM at a random time of a gfpd that records and has subscribers.
Trial termination_trial(std::uint64_t number);

}  // namespace gfp::test
