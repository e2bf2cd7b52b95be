#pragma once

#include <memory>
#include <string>
#include <vector>
#include <zmq.hpp>

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

/// One XPUB socket, bound to its endpoints. One thread at a time.
struct PublisherSocket {
  std::vector<EndpointLock> locks;
  zmq::socket_t socket;
};

/// Errors: kIo, naming the endpoint and what the system said.
Result<PublisherSocket> bind_publisher(zmq::context_t& context, const std::vector<std::string>& endpoints, int high_water_mark);

}  // namespace gfp
