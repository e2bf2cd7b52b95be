#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "gfp/client/curve_key.hpp"
#include "gfp/core/error.hpp"

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
  zmq::socket_t socket;
};

/// What holds for all of the daemon's sockets.
struct SocketOptions {
  int high_water_mark = 1000;          ///< Messages that wait for one slow peer.
  std::int64_t max_message_bytes = -1; ///< A peer that sends more is not one of ours: it is cut off before it is read. -1: no limit.
  const CurveKey* curve_key = nullptr; ///< tcp endpoints are encrypted with it, and their peers have to pass the KeyGate.
};

/// Errors: kIo, naming the endpoint and what the system said.
Result<BoundSocket> bind_socket(zmq::context_t& context, zmq::socket_type type, const std::vector<std::string>& endpoints, const SocketOptions& options);

}  // namespace gfp
