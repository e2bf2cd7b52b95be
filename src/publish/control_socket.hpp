#pragma once

#include <functional>
#include <string>
#include <zmq.hpp>

#include "gfp/v1/control.pb.h"
#include "publish/sockets.hpp"

namespace gfp {

/// A client of the control socket, as far as its reply needs to know.
struct ControlPeer {
  std::string identity;          ///< ZeroMQ's routing id.
  bool has_delimiter = false;    ///< REQ sends an empty frame first, and wants one back.
};

struct PeerRequest {
  ControlPeer peer;
  v1::ControlRequest request;
};

struct PeerReply {
  ControlPeer peer;
  v1::ControlReply reply;
};

/// The ROUTER behind control_endpoints. One thread at a time.
class ControlSocket {
 public:
  explicit ControlSocket(BoundSocket socket) : socket_(std::move(socket)) {}
  zmq::socket_t& socket() { return socket_.socket; }
  BoundSocket& bound() { return socket_; }

  /// Takes in what waits, at most kAtOnce requests, so that a flood does not keep the publisher from publishing. Requests for the
  /// schemas, and nonsense, are answered here.
  void read(const std::function<void(PeerRequest)>& take);

  /// Never blocks: a peer that is gone or does not read loses its reply.
  void send(const PeerReply& reply);

  static constexpr std::int64_t kMaxRequestBytes = 1 << 20;
  static constexpr int kHighWaterMark = 16;

 private:
  void answer(const std::string& body, ControlPeer peer, const std::function<void(PeerRequest)>& take);
  void send(const ControlPeer& peer, const std::string& body);

  static constexpr int kAtOnce = 32;
  BoundSocket socket_;
};

/// A reply that says why not.
v1::ControlReply refusal(const v1::ControlRequest& request, v1::ControlReply::Code code, std::string why);

}  // namespace gfp
