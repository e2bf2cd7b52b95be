#pragma once

#include <zmq.hpp>

#include "gfp/client/subscriber.hpp"

namespace gfp {

/// What all client sockets share: reconnection, heartbeats, CURVE. Errors: kInvalidArgument (half a key).
inline Result<void> prepare_client(zmq::socket_t& socket, const CurveAccess& curve) {
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::reconnect_ivl, 100);
  socket.set(zmq::sockopt::reconnect_ivl_max, 1000);
  socket.set(zmq::sockopt::heartbeat_ivl, 1000);
  socket.set(zmq::sockopt::heartbeat_timeout, 3000);
  socket.set(zmq::sockopt::heartbeat_ttl, 10'000);  // a daemon that hears nothing for so long lets go of us, even where it cannot send us a word
  socket.set(zmq::sockopt::ipv6, true);
  if (curve.server_public_key.empty()) return {};
  constexpr std::size_t kLength = 40;
  if (curve.server_public_key.size() != kLength || curve.key.public_key.size() != kLength || curve.key.secret_key.size() != kLength)
    return failure(ErrorCode::kInvalidArgument, "curve: expected the daemon's public key and both halves of one's own, 40 characters each");
  socket.set(zmq::sockopt::curve_serverkey, curve.server_public_key);
  socket.set(zmq::sockopt::curve_publickey, curve.key.public_key);
  socket.set(zmq::sockopt::curve_secretkey, curve.key.secret_key);
  return {};
}

}  // namespace gfp
