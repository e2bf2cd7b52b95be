#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <zmq.hpp>

#include "gfp/core/time.hpp"
#include "gfp/v1/envelope.pb.h"
#include "publish/demand.hpp"
#include "publish/sockets.hpp"

namespace gfp {

/// Bytes that travel as they are, after the payload; `owner` keeps them alive until the socket has sent them.
struct OutletBlob {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
  v1::Envelope::Encoding encoding = v1::Envelope::ENCODING_RAW;
};

/// One XPUB socket with its subscribers' demand and its topics' sequences. One thread at a time.
class Outlet {
 public:
  Outlet(BoundSocket socket, std::uint64_t session) : socket_(std::move(socket)), session_(session) {}

  using Blob = OutletBlob;

  zmq::socket_t& socket() { return socket_.socket; }
  BoundSocket& bound() { return socket_; }
  const Demand& demand() const { return demand_; }

  /// Of the next message of a topic.
  std::uint64_t next_seq(const std::string& topic) const {
    const auto found = next_seq_.find(topic);
    return found == next_seq_.end() ? 0 : found->second;
  }

  /// Takes in waiting subscriptions; calls `joined(prefix)` for each new one, and tells the guard whose they are.
  template <class Joined>
  void read_subscriptions(ConnectionGuard& guard, Joined&& joined) {
    zmq::message_t message;
    while (socket_.socket.recv(message, zmq::recv_flags::dontwait)) {
      if (message.size() > 0) guard.subscribed(zmq_msg_get(message.handle(), ZMQ_SRCFD), *message.data<char>() == 1);
      const std::string prefix = demand_.update({message.data<std::byte>(), message.size()});
      if (!prefix.empty()) joined(prefix);
    }
  }

  /// Sends [topic][Envelope][payload][blob]. Never blocks: beyond its high-water mark a subscriber misses the message and
  /// sees the gap in `seq`. Callers ask demand() first, so that nothing is serialised for nobody.
  void send(const std::string& topic, const google::protobuf::Message& payload, const Stamps& stamps, std::uint64_t dropped = 0, Blob blob = {});

  std::uint64_t messages() const { return messages_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint64_t hash_of(const google::protobuf::Descriptor& descriptor);

  BoundSocket socket_;
  std::uint64_t session_;
  Demand demand_;
  std::map<std::string, std::uint64_t> next_seq_;
  std::map<const google::protobuf::Descriptor*, std::uint64_t> schema_hashes_;
  std::uint64_t messages_ = 0, bytes_ = 0;
};

}  // namespace gfp
