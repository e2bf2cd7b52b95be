#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <zmq.hpp>

#include "publish/control_socket.hpp"
#include "publish/inbox.hpp"
#include "publish/key_gate.hpp"
#include "publish/outlet.hpp"
#include "publish/publish_options.hpp"
#include "recording/compression.hpp"
#include "wire/mesh_messages.hpp"

namespace gfp {

/// Takes requests that the publisher cannot answer by itself; called on the publisher's thread, so it must not block. The answer
/// comes with put(PeerReply).
using ControlHandler = std::function<void(PeerRequest)>;

/// The only owner of the daemon's sockets: one thread, two XPUB sockets and a ROUTER (DESIGN, endpoints and topics).
///
///     drivers, pipeline, log --put()--> Inbox (latest value a kind) --publisher thread--> sensor | state socket
///     Over tcp: sensor topics from a socket of their own, depth compressed. A key that is taken away ends all connections over tcp;
///     those that may come again do so within a second.
///     control socket --requests--> snapshots: publisher thread; all else: ControlHandler --put()--> Inbox --> control socket
///
/// State topics repeat their last value once in `heartbeat_s` of silence, topologies and statuses every heartbeat and to each
/// late joiner at once, so that a subscriber that comes at any time converges. put() is safe from any thread.
class Publisher {
 public:
  /// Binds the endpoints and starts the thread. `session` tells this start of the daemon from others.
  /// Errors: kIo (an endpoint that cannot be bound); kNotFound, kCorruptData (the key, the folder of authorized keys).
  static Result<std::unique_ptr<Publisher>> start(const PublishOptions& options, std::uint64_t session, ControlHandler control = {});
  ~Publisher();  ///< As stop().

  void put(FramePtr frame) { put_twice(std::move(frame)); }
  void put(ScenePtr scene) { put_twice(std::move(scene)); }
  void put(v1::SensorStatus status) { put_twice(std::move(status)); }
  void put(v1::LogRecord record) { put_twice(std::move(record)); }

  /// From now on what is put here goes to `other` too: the view's, say. It must outlive all calls of put().
  void mirror(Inbox* other) { mirror_ = other; }

  void put(PeerReply reply) { inbox_.put(std::move(reply)); }

  /// What another method made of a frame (`profile` is its name): goes to /gfp/shadow/<method>/.
  void put_shadow(ScenePtr scene, std::uint64_t dropped) {
    if (Inbox* other = mirror_.load()) other->put_shadow(scene, dropped);
    inbox_.put_shadow(std::move(scene), dropped);
  }

  /// Who was refused or cut off since the last call. Safe from any thread.
  std::vector<Refusal> take_refusals() { return guard_->take_refusals(); }

  /// Sends what waits and the daemon's last status, then closes the sockets (up to half a second for slow subscribers).
  void stop();

 private:
  struct Sockets {
    std::unique_ptr<zmq::context_t> context;
    std::unique_ptr<KeyGate> gate;  ///< Empty: tcp is open to everybody, or to nobody.
    BoundSocket sensor, state, control;
    std::optional<BoundSocket> remote_sensor;  ///< Of the sensor topics over tcp: what is sent there is coded otherwise.
    std::unique_ptr<ConnectionGuard> guard;
  };
  static Result<Sockets> open_sockets(const PublishOptions& options);
  Publisher(const PublishOptions& options, std::uint64_t session, ControlHandler control, Sockets sockets);

  void run(const std::stop_token& stop);
  void send_content();
  void send_frame(const Latest<FramePtr>& frame, Outlet& outlet, bool compress_depth);
  Outlet::Blob compressed_depth(const Frame& frame);
  void cut_revoked();
  void take_scene(const Latest<ScenePtr>& scene, const std::set<std::uint64_t>& lost);
  void send_scene(const Scene& scene, std::uint64_t dropped, const std::set<std::uint64_t>& lost);
  void send_lost(const Scene& scene, std::uint64_t id);
  void send_shadow(const Latest<ScenePtr>& shadow);
  void repeat_scenes(Nanoseconds not_since);
  void serve_late_joiners();
  void send_topology(const FittedModel& model);
  void send_topologies(std::string_view below);
  void send_daemon_status(const char* state);
  v1::DaemonStatus daemon_status(const char* state) const;
  void heartbeat();
  void joined(const std::string& prefix);
  void take_request(PeerRequest request);
  void send_reply(PeerReply reply);
  v1::ControlReply snapshot(const v1::ControlRequest& request) const;

  template <class T>
  void put_twice(T value) {
    if (Inbox* other = mirror_) other->put(value);
    inbox_.put(std::move(value));
  }

  struct KnownTopology {
    std::shared_ptr<const Topology> topology;
    std::size_t vertices = 0;
    std::uint64_t last_used = 0;  ///< Count of scenes at its last use: the oldest goes first.
  };
  struct LastScene {
    ScenePtr scene;
    Nanoseconds sent{};  ///< Monotonic.
    std::map<std::uint64_t, Nanoseconds> lost;  ///< Ids that went within kTellLost: a late joiner's snapshot may be older than that.
  };
  static constexpr std::size_t kMaxTopologies = 256;
  static constexpr Nanoseconds kTellLost{60'000'000'000};
  static constexpr Nanoseconds kBindAgain{20'000'000};  ///< Between attempts to have cut endpoints back.
  static constexpr Nanoseconds kMinRepeat{50'000'000};  ///< Late joiners, however many, cause no more traffic than this.

  const PublishOptions options_;
  const wire::VertexCoding coding_;
  const Nanoseconds started_;
  const std::uint64_t session_;
  const ControlHandler handler_;
  std::unique_ptr<zmq::context_t> context_;
  Inbox inbox_;
  std::atomic<Inbox*> mirror_ = nullptr;
  // From here on: the publisher thread's own.
  Outlet sensor_, state_;
  std::optional<Outlet> remote_sensor_;
  ZstdCompressor zstd_{1};
  bool is_cut_ = false;  ///< Remote endpoints wait to be bound again.
  ControlSocket control_;
  std::unique_ptr<KeyGate> gate_;  ///< After the sockets: it ends the context's work before they close.
  std::unique_ptr<ConnectionGuard> guard_;  ///< After the sockets and the gate.
  std::map<std::uint64_t, KnownTopology> topologies_;
  std::map<std::string, LastScene> last_scenes_;  ///< By sensor.
  std::map<std::string, v1::SensorStatus> statuses_;
  Nanoseconds joined_{}, served_{};  ///< Monotonic: when the last subscriber came, when late joiners were last served.
  std::optional<Nanoseconds> serve_at_;  ///< When to serve them next.
  std::uint64_t scenes_ = 0, dropped_ = 0;
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace gfp
