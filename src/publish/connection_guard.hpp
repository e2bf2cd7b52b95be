#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <string>
#include <utility>
#include <vector>
#include <zmq.hpp>

#include "gfp/core/mutex.hpp"

namespace gfp {

/// Connections of one peer that were not let in, or cut off, since they were last asked for.
struct Refusal {
  std::string peer;  ///< Address; `this host` over ipc.
  std::string why;   ///< The last time.
  std::uint64_t count = 0;
};

/// Watches who connects to the daemon's sockets, which ZeroMQ itself does not limit: ends connections beyond a number, and those that
/// subscribe without end, and keeps account of who did not pass the handshake. Of the publisher's thread, but for take_refusals().
///
/// ZeroMQ tells of connections by their descriptor, after the fact; it may have closed it and the number be another file's by now. What
/// is ended is therefore first held, and must be the very socket that was accepted (its inode).
class ConnectionGuard {
 public:
  explicit ConnectionGuard(int max_connections) : max_connections_(static_cast<std::size_t>(max_connections)) {}
  ~ConnectionGuard();  ///< Before the sockets that it watches: ZeroMQ's thread waits for ever to tell one that does not listen any more.
  ConnectionGuard(const ConnectionGuard&) = delete;
  ConnectionGuard& operator=(const ConnectionGuard&) = delete;

  /// To be called before the socket is bound.
  void watch(zmq::context_t& context, zmq::socket_t& socket);
  /// Sockets to poll for input, and then to read().
  std::vector<zmq::socket_t*> monitors();
  /// Takes in what happened.
  void read();
  /// A subscription (or its end) that came over this descriptor; -1: over a connection that is gone.
  void subscribed(int descriptor, bool begins);
  /// Forgets connections that ended without a word, as those of an endpoint that was unbound do. Now and then.
  void prune();

  std::size_t connections() const { return connections_.size(); }
  std::uint64_t refused() const { return refused_; }
  /// By peer; at most kMaxRefusals, the rest summed up in one of `others`. Safe from any thread.
  std::vector<Refusal> take_refusals();

  static constexpr std::size_t kMaxSubscriptions = 1000;  ///< Of one connection.

 private:
  struct Connection {
    std::uint64_t inode = 0;
    std::string peer;
    std::size_t subscriptions = 0;
  };
  struct Watched {
    void* socket = nullptr;
    zmq::socket_t monitor;
    std::string failure;   ///< Of the connection that ZeroMQ is about to close.
    bool gave_up = false;  ///< Likewise: it ended within the handshake.
  };

  void take(Watched& watched, std::uint16_t event, std::uint32_t value);
  void accepted(int descriptor);
  void cut(int descriptor, const Connection& connection, const std::string& why);
  void refuse(const std::string& peer, const std::string& why);

  static constexpr std::size_t kMaxRefusals = 8;

  const std::size_t max_connections_;
  std::list<Watched> watched_;
  std::map<int, Connection> connections_;  ///< By descriptor.
  std::uint64_t refused_ = 0;
  Mutex mutex_;
  std::map<std::string, Refusal> refusals_ GFP_GUARDED_BY(mutex_);  ///< By peer.
};

}  // namespace gfp
