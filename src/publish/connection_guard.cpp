#include "publish/connection_guard.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace gfp {
namespace {

constexpr int kEvents = ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_CLOSED | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL;
constexpr const char* kThisHost = "this host";

/// 0: no socket.
std::uint64_t inode_of(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISSOCK(status.st_mode) ? status.st_ino : 0;
}

std::string peer_of(int descriptor) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  if (getpeername(descriptor, reinterpret_cast<sockaddr*>(&address), &length) != 0) return "a peer that is gone";
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.ss_family == AF_INET) inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in&>(address).sin_addr, text.data(), text.size());
  else if (address.ss_family == AF_INET6) inet_ntop(AF_INET6, &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, text.data(), text.size());
  else return kThisHost;
  return text.data();
}

}  // namespace

ConnectionGuard::~ConnectionGuard() {
  for (const Watched& watched : watched_) zmq_socket_monitor(watched.socket, nullptr, 0);
}

void ConnectionGuard::watch(zmq::context_t& context, zmq::socket_t& socket) {
  const std::string address = fmt::format("inproc://gfp.connections.{}", watched_.size());
  if (zmq_socket_monitor(socket.handle(), address.c_str(), kEvents) != 0) throw zmq::error_t();
  Watched& watched = watched_.emplace_back(Watched{socket.handle(), zmq::socket_t(context, zmq::socket_type::pair), {}, false});
  watched.monitor.set(zmq::sockopt::linger, 0);
  watched.monitor.set(zmq::sockopt::rcvhwm, 0);  // else ZeroMQ's own thread waits for the one that reads here
  watched.monitor.connect(address);
}

std::vector<zmq::socket_t*> ConnectionGuard::monitors() {
  std::vector<zmq::socket_t*> sockets;
  for (Watched& watched : watched_) sockets.push_back(&watched.monitor);
  return sockets;
}

void ConnectionGuard::read() {
  for (Watched& watched : watched_) {
    zmq::message_t head, endpoint;
    while (watched.monitor.recv(head, zmq::recv_flags::dontwait)) {
      if (head.more()) static_cast<void>(watched.monitor.recv(endpoint, zmq::recv_flags::dontwait));
      std::uint16_t event = 0;
      std::uint32_t value = 0;
      if (head.size() != sizeof event + sizeof value) continue;
      std::memcpy(&event, head.data<char>(), sizeof event);
      std::memcpy(&value, head.data<char>() + sizeof event, sizeof value);
      take(watched, event, value);
    }
  }
}

void ConnectionGuard::take(Watched& watched, std::uint16_t event, std::uint32_t value) {
  switch (event) {
    case ZMQ_EVENT_ACCEPTED: return accepted(static_cast<int>(value));
    case ZMQ_EVENT_HANDSHAKE_FAILED_AUTH: watched.failure = "its key is not authorized"; return;
    case ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL: watched.failure = "no key, or one that is not right"; return;
    case ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL: watched.gave_up = true; return;
    default: break;  // closed, by whomever
  }
  const auto found = connections_.find(static_cast<int>(value));
  const std::string peer = found == connections_.end() ? "a peer that is gone" : found->second.peer;
  // A client without a key may see it first, and leave. Over ipc it just came and went.
  if (std::exchange(watched.gave_up, false) && watched.failure.empty() && peer != kThisHost) watched.failure = "it left before it was let in, or said nothing";
  if (!watched.failure.empty()) refuse(peer, std::exchange(watched.failure, {}));
  if (found != connections_.end()) connections_.erase(found);
}

void ConnectionGuard::accepted(int descriptor) {
  Connection& connection = connections_[descriptor];
  connection = {inode_of(descriptor), peer_of(descriptor), 0};
  if (connections_.size() > max_connections_) cut(descriptor, connection, fmt::format("publish.max_connections = {} are there", max_connections_));
}

void ConnectionGuard::subscribed(int descriptor, bool begins) {
  const auto found = connections_.find(descriptor);
  if (found == connections_.end()) return;
  std::size_t& subscriptions = found->second.subscriptions;
  if (!begins) subscriptions -= subscriptions > 0 ? 1 : 0;
  else if (++subscriptions == kMaxSubscriptions + 1) cut(descriptor, found->second, fmt::format("more than {} subscriptions", kMaxSubscriptions));
}

/// ZeroMQ sees the end of the connection and closes it; until then it stays in the account.
void ConnectionGuard::cut(int descriptor, const Connection& connection, const std::string& why) {
  const int held = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  if (held < 0) return;
  if (connection.inode != 0 && inode_of(held) == connection.inode) {
    shutdown(held, SHUT_RDWR);
    refuse(connection.peer, why);
  }
  close(held);
}

void ConnectionGuard::prune() {
  std::erase_if(connections_, [](const auto& entry) { return entry.second.inode == 0 || inode_of(entry.first) != entry.second.inode; });
}

void ConnectionGuard::refuse(const std::string& peer, const std::string& why) {
  ++refused_;
  MutexLock lock(mutex_);
  const bool has_room = refusals_.size() + 1 < kMaxRefusals || refusals_.contains(peer);
  Refusal& refusal = refusals_[has_room ? peer : "others"];
  refusal = {has_room ? peer : "others", why, refusal.count + 1};
}

std::vector<Refusal> ConnectionGuard::take_refusals() {
  std::vector<Refusal> taken;
  MutexLock lock(mutex_);
  for (auto& [peer, refusal] : std::exchange(refusals_, {})) taken.push_back(std::move(refusal));
  return taken;
}

}  // namespace gfp
