#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <zmq.hpp>

#include "publish/inbox.hpp"
#include "publish/outlet.hpp"
#include "publish/publish_options.hpp"
#include "wire/mesh_messages.hpp"

namespace gfp {

/// The only owner of the daemon's data sockets: one thread, two XPUB sockets (DESIGN, endpoints and topics).
///
///     drivers, pipeline, log --put()--> Inbox (latest value a kind) --publisher thread--> sensor | state socket
///
/// State topics repeat their last value once in `heartbeat_s` of silence, topologies and statuses every heartbeat and to each
/// late joiner at once, so that a subscriber that comes at any time converges. put() is safe from any thread.
class Publisher {
 public:
  /// Binds the endpoints and starts the thread. `session` tells this start of the daemon from others.
  /// Errors: kIo (an endpoint that cannot be bound).
  static Result<std::unique_ptr<Publisher>> start(const PublishOptions& options, std::uint64_t session);
  ~Publisher();  ///< As stop().

  void put(FramePtr frame) { inbox_.put(std::move(frame)); }
  void put(ScenePtr scene) { inbox_.put(std::move(scene)); }
  void put(v1::SensorStatus status) { inbox_.put(std::move(status)); }
  void put(v1::LogRecord record) { inbox_.put(std::move(record)); }

  /// Sends what waits and the daemon's last status, then closes the sockets (up to half a second for slow subscribers).
  void stop();

 private:
  Publisher(const PublishOptions& options, std::uint64_t session, std::unique_ptr<zmq::context_t> context, PublisherSocket sensor, PublisherSocket state);

  void run(const std::stop_token& stop);
  void send_content();
  void send_frame(const Latest<FramePtr>& frame);
  void take_scene(const Latest<ScenePtr>& scene, const std::set<std::uint64_t>& lost);
  void send_scene(const Scene& scene, std::uint64_t dropped, const std::set<std::uint64_t>& lost);
  void repeat_scenes(Nanoseconds not_since);
  void serve_late_joiners();
  void send_topology(const FittedModel& model);
  void send_topologies(std::string_view below);
  void send_daemon_status(const char* state);
  void heartbeat();
  void joined(const std::string& prefix);

  struct KnownTopology {
    std::shared_ptr<const Topology> topology;
    std::size_t vertices = 0;
    std::uint64_t last_used = 0;  ///< Count of scenes at its last use: the oldest goes first.
  };
  struct LastScene {
    ScenePtr scene;
    Nanoseconds sent{};  ///< Monotonic.
  };
  static constexpr std::size_t kMaxTopologies = 256;
  static constexpr Nanoseconds kMinRepeat{50'000'000};  ///< Late joiners, however many, cause no more traffic than this.

  const PublishOptions options_;
  const wire::VertexCoding coding_;
  const Nanoseconds started_;
  std::unique_ptr<zmq::context_t> context_;
  Inbox inbox_;
  // From here on: the publisher thread's own.
  Outlet sensor_, state_;
  std::map<std::uint64_t, KnownTopology> topologies_;
  std::map<std::string, LastScene> last_scenes_;  ///< By sensor.
  std::map<std::string, v1::SensorStatus> statuses_;
  Nanoseconds joined_{}, served_{};  ///< Monotonic: when the last subscriber came, when late joiners were last served.
  std::optional<Nanoseconds> serve_at_;  ///< When to serve them next.
  std::uint64_t scenes_ = 0, dropped_ = 0;
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
