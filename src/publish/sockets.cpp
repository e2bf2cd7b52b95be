#include "publish/sockets.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

namespace gfp {
namespace {

constexpr std::int64_t kMaxSubscriptionBytes = 4096;  ///< Whoever sends more to a publisher is not a subscriber of ours.
constexpr int kLingerMs = 500;               ///< What is left to send at the end may take so long.

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

Result<PublisherSocket> bind_publisher(zmq::context_t& context, const std::vector<std::string>& endpoints, int high_water_mark) {
  PublisherSocket bound;
  try {
    bound.socket = zmq::socket_t(context, zmq::socket_type::xpub);
    bound.socket.set(zmq::sockopt::sndhwm, high_water_mark);
    bound.socket.set(zmq::sockopt::xpub_verbose, true);  // each late joiner is seen, and gets what it needs at once
    bound.socket.set(zmq::sockopt::linger, kLingerMs);
    bound.socket.set(zmq::sockopt::maxmsgsize, kMaxSubscriptionBytes);
    bound.socket.set(zmq::sockopt::heartbeat_ivl, 1000);
    bound.socket.set(zmq::sockopt::heartbeat_timeout, 3000);
    bound.socket.set(zmq::sockopt::handshake_ivl, 3000);
    bound.socket.set(zmq::sockopt::ipv6, true);
  } catch (const zmq::error_t& error) {
    return failure(ErrorCode::kIo, fmt::format("publisher socket: {}", error.what()));
  }
  for (const std::string& endpoint : endpoints) {
    auto lock = EndpointLock::take(endpoint);
    if (!lock) return tl::unexpected(lock.error());
    bound.locks.push_back(std::move(*lock));
    try {
      bound.socket.bind(endpoint);
    } catch (const zmq::error_t& error) {
      return failure(ErrorCode::kIo, fmt::format("{}: {}", endpoint, error.what()));
    }
  }
  return bound;
}

}  // namespace gfp
