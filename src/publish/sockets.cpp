#include "publish/sockets.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "publish/key_gate.hpp"

namespace gfp {
namespace {

constexpr int kTakesNothingMs = 15'000;  ///< A peer over tcp that takes nothing for so long is cut off by the system.
constexpr int kLingerMs = 500;  ///< What is left to send at the end may take so long.

}  // namespace

Result<EndpointLock> EndpointLock::take(const std::string& endpoint) {
  constexpr std::string_view kScheme = "ipc://";
  if (!endpoint.starts_with(kScheme)) return EndpointLock(-1);
  const std::filesystem::path path = endpoint.substr(kScheme.size());
  std::error_code status;
  if (std::filesystem::create_directories(path.parent_path(), status))
    std::filesystem::permissions(path.parent_path(), std::filesystem::perms::owner_all, status);
  const std::string lock = path.string() + ".lock";
  const int file = open(lock.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) return failure(ErrorCode::kIo, fmt::format("{}: {}", lock, std::strerror(errno)));
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    close(file);
    return failure(ErrorCode::kIo, fmt::format("{}: another gfpd serves this endpoint", endpoint));
  }
  return EndpointLock(file);
}

EndpointLock::EndpointLock(EndpointLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

EndpointLock::~EndpointLock() {
  if (file_ >= 0) close(file_);
}

namespace {

zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type, const SocketOptions& options) {
  zmq::socket_t socket(context, type);
  socket.set(zmq::sockopt::sndhwm, options.high_water_mark);
  socket.set(zmq::sockopt::rcvhwm, options.high_water_mark);
  if (type == zmq::socket_type::xpub) socket.set(zmq::sockopt::xpub_verbose, true);  // each late joiner is seen, and gets what it needs at once
  socket.set(zmq::sockopt::linger, kLingerMs);
  socket.set(zmq::sockopt::maxmsgsize, options.max_message_bytes);
  // No heartbeat of its own: to a peer that takes nothing it is never sent, and its answer would end the countdown (TTL) that each
  // heartbeat of our clients begins anew. Other clients are the system's to find out about, over tcp.
  socket.set(zmq::sockopt::tcp_maxrt, kTakesNothingMs);
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::tcp_keepalive_idle, kTakesNothingMs / 1000);
  socket.set(zmq::sockopt::tcp_keepalive_intvl, 3);
  socket.set(zmq::sockopt::tcp_keepalive_cnt, 3);
  socket.set(zmq::sockopt::handshake_ivl, 3000);
  socket.set(zmq::sockopt::ipv6, true);
  return socket;
}

/// ZeroMQ copies a socket's options when an endpoint is bound: the same socket serves ipc as it is, and tcp behind the key.
void protect(zmq::socket_t& socket, const CurveKey& key) {
  socket.set(zmq::sockopt::curve_server, true);
  socket.set(zmq::sockopt::curve_secretkey, key.secret_key);
  socket.set(zmq::sockopt::zap_domain, KeyGate::kDomain);
}

}  // namespace

/// ZeroMQ owns the connections that came in over an endpoint with it: they end with it, and it has no other way to end one.
void BoundSocket::cut_remote() {
  for (const std::string& endpoint : remote) {
    if (std::find(unbound.begin(), unbound.end(), endpoint) != unbound.end()) continue;
    socket.unbind(endpoint);
    unbound.push_back(endpoint);
  }
}

bool BoundSocket::bind_again() {
  std::erase_if(unbound, [&](const std::string& endpoint) {
    try {
      socket.bind(endpoint);
      return true;
    } catch (const zmq::error_t&) {  // the old one is closed by another thread, in its own time
      return false;
    }
  });
  return unbound.empty();
}

Result<BoundSocket> bind_socket(zmq::context_t& context, zmq::socket_type type, const std::vector<std::string>& endpoints, const SocketOptions& options) {
  BoundSocket bound;
  std::vector<std::string> ordered = endpoints;
  const auto first_tcp = std::stable_partition(ordered.begin(), ordered.end(), [](const std::string& endpoint) { return !is_remote(endpoint); });
  try {
    bound.socket = make_socket(context, type, options);
    if (options.guard != nullptr) options.guard->watch(context, bound.socket);
  } catch (const zmq::error_t& error) {
    return failure(ErrorCode::kIo, fmt::format("socket: {}", error.what()));
  }
  for (auto endpoint = ordered.begin(); endpoint != ordered.end(); ++endpoint) {
    auto lock = EndpointLock::take(*endpoint);
    if (!lock) return tl::unexpected(lock.error());
    bound.locks.push_back(std::move(*lock));
    try {
      if (endpoint == first_tcp && options.curve_key != nullptr) protect(bound.socket, *options.curve_key);
      bound.socket.bind(*endpoint);
      if (is_remote(*endpoint)) bound.remote.push_back(bound.socket.get(zmq::sockopt::last_endpoint));
    } catch (const zmq::error_t& error) {
      return failure(ErrorCode::kIo, fmt::format("{}: {}", *endpoint, error.what()));
    }
  }
  return bound;
}

}  // namespace gfp
