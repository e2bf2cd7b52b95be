#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "gfp/client/curve_key.hpp"
#include "gfp/core/error.hpp"
#include "publish/connection_guard.hpp"

namespace gfp {

/// Keeps an ipc endpoint to one daemon: ZeroMQ would silently take a path over from the process that serves it.
class EndpointLock {
 public:
  /// Makes the folder (0700) and takes `<path>.lock`. Not ipc: nothing to do. Errors: kIo, naming who is in the way.
  static Result<EndpointLock> take(const std::string& endpoint);
  EndpointLock(EndpointLock&& other) noexcept;
  EndpointLock& operator=(EndpointLock&&) = delete;
  ~EndpointLock();

 private:
  explicit EndpointLock(int file) : file_(file) {}
  int file_;
};

/// A socket, bound to its endpoints, with the locks of those that are files. One thread at a time.
struct BoundSocket {
  std::vector<EndpointLock> locks;
  std::vector<std::string> remote;   ///< Its tcp endpoints, as the system bound them.
  std::vector<std::string> unbound;  ///< Of these: those that are to be bound again.
  zmq::socket_t socket;

  /// Ends every connection over tcp: peers connect again by themselves, and have to pass the KeyGate again.
  void cut_remote();
  /// Binds again what was cut; false: the system does not give all of it back yet, ask again soon.
  bool bind_again();
};

inline bool is_remote(const std::string& endpoint) { return endpoint.starts_with("tcp://"); }

/// What holds for all of the daemon's sockets.
struct SocketOptions {
  int high_water_mark = 1000;          ///< Messages that wait for one slow peer.
  std::int64_t max_message_bytes = -1; ///< A peer that sends more is not one of ours: it is cut off before it is read. -1: no limit.
  ConnectionGuard* guard = nullptr;    ///< Watches the socket's connections; may be empty.
  const CurveKey* curve_key = nullptr; ///< tcp endpoints are encrypted with it, and their peers have to pass the KeyGate.
};

/// Errors: kIo, naming the endpoint and what the system said.
Result<BoundSocket> bind_socket(zmq::context_t& context, zmq::socket_type type, const std::vector<std::string>& endpoints, const SocketOptions& options);

}  // namespace gfp
