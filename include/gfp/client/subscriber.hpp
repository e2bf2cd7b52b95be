#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gfp/client/curve_key.hpp"
#include "gfp/core/error.hpp"
#include "gfp/core/time.hpp"
#include "gfp/frame/frame.hpp"

namespace gfp {

/// One message of a topic: what its Envelope says, and the bytes (proto/gfp/v1/envelope.proto).
struct Message {
  std::string topic;
  std::string schema;                    ///< Of the payload, as in `gfp.v1.Scene`.
  std::uint64_t schema_hash = 0;
  std::uint64_t session = 0;             ///< Of the daemon: new with every start.
  std::uint64_t seq = 0;                 ///< Of the topic in this session.
  std::uint64_t dropped_since_last = 0;  ///< By the sender, before its socket.
  Stamps stamps;                         ///< Of the frame behind it; zero where there is none.
  Nanoseconds published{};               ///< Sender's CLOCK_REALTIME.
  double age_s = 0;                      ///< From publishing to receiving; of meaning on one host, or with synchronised clocks.
  std::string payload;
  std::string blob;                      ///< Pixels of images; else empty.
};

/// What a client needs for a daemon that serves tcp with CURVE. Empty: unencrypted, as over ipc.
struct CurveAccess {
  std::string server_public_key;  ///< Of the daemon.
  CurveKey key;                   ///< One's own; its public half has to be among the daemon's authorized keys.
};

struct SubscriberOptions {
  std::vector<std::string> endpoints;  ///< Empty: the default ones of this host that carry the topics.
  double stale_after_s = 1.0;          ///< Messages older than this on arrival are counted as stale.
  int high_water_mark = 1000;          ///< Messages that wait here before new ones are lost.
  CurveAccess curve;
};

/// What happened on the way; all since connect().
struct SubscriberCounts {
  std::uint64_t received = 0;
  std::uint64_t bytes = 0;     ///< As they came, compressed or not.
  std::uint64_t missed = 0;    ///< Gaps in `seq`: lost between the sender's socket and here.
  std::uint64_t restarts = 0;  ///< Times a topic came with a new session: the daemon was started anew.
  std::uint64_t stale = 0;
  std::uint64_t corrupt = 0;   ///< Not a message of ours; skipped.
};

/// Listens to topics of a gfpd, on this host or another; reconnects by itself, whoever comes first. One thread at a time.
class Subscriber {
 public:
  /// `topics` are names or prefixes of them, as in `/gfp/scene/`. Errors: kInvalidArgument (a topic that does not begin with
  /// `/`), kIo (an endpoint that ZeroMQ refuses). A daemon that is not there yet is not an error.
  static Result<Subscriber> connect(const std::vector<std::string>& topics, const SubscriberOptions& options = {});
  Subscriber(Subscriber&&) noexcept;
  Subscriber& operator=(Subscriber&&) noexcept;
  ~Subscriber();

  /// The next message. Errors: kTimeout, kCorruptData (one message was skipped: ask again), kIo.
  Result<Message> receive(std::chrono::milliseconds timeout);
  const SubscriberCounts& counts() const;

  /// Time since the last message, or since connect(). A daemon says something every second: /gfp/status/gfpd/.
  double silent_for_s() const;

 private:
  struct Sockets;
  explicit Subscriber(std::unique_ptr<Sockets> sockets);
  std::unique_ptr<Sockets> sockets_;
};

/// The depth image of a message of `/gfp/sensor/<name>/depth/`. Errors: kUnsupported (another schema), kTooLarge, kCorruptData.
Result<DepthImage> depth_image(const Message& message);

}  // namespace gfp
