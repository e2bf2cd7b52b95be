#include "publish/publisher.hpp"

#include <algorithm>

#include "gfp/core/version.hpp"
#include "wire/bounded_parse.hpp"
#include "wire/scene_messages.hpp"
#include "wire/sensor_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {

namespace {

constexpr std::int64_t kMaxSubscriptionBytes = 4096;  ///< Whoever sends more to a publisher is not a subscriber of ours.

std::vector<std::string> or_default(const std::vector<std::string>& given, const char* name) {
  return given.empty() ? std::vector<std::string>{wire::default_endpoint(name)} : given;
}

}  // namespace

Result<Publisher::Sockets> Publisher::open_sockets(const PublishOptions& options) {
  Sockets sockets;
  sockets.context = std::make_unique<zmq::context_t>(1);
  sockets.guard = std::make_unique<ConnectionGuard>(options.max_connections);
  ConnectionGuard* const guard = sockets.guard.get();
  CurveKey key;
  if (!options.curve_key.empty()) {
    auto read = read_curve_key(options.curve_key);
    if (!read) return tl::unexpected(read.error());
    if (read->secret_key.empty()) return failure(ErrorCode::kCorruptData, options.curve_key + ": only a public key, expected the daemon's .key file");
    key = std::move(*read);
    auto gate = KeyGate::open(*sockets.context, options.authorized_keys);
    if (!gate) return tl::unexpected(gate.error());
    sockets.gate = std::move(*gate);
  }
  const CurveKey* curve = key.secret_key.empty() ? nullptr : &key;
  const auto bind = [&](BoundSocket& bound, zmq::socket_type type, const std::vector<std::string>& endpoints, const SocketOptions& socket_options) -> Result<void> {
    auto made = bind_socket(*sockets.context, type, endpoints, socket_options);
    if (!made) return tl::unexpected(made.error());
    bound = std::move(*made);
    return {};
  };
  using Type = zmq::socket_type;
  std::vector<std::string> local = or_default(options.sensor_endpoints, "sensor");
  const auto first_remote = std::stable_partition(local.begin(), local.end(), [](const std::string& endpoint) { return !is_remote(endpoint); });
  const std::vector<std::string> remote(first_remote, local.end());
  local.erase(first_remote, local.end());
  const SocketOptions sensor_options{options.sensor_high_water_mark, kMaxSubscriptionBytes, guard, curve};
  if (auto made = bind(sockets.sensor, Type::xpub, local, sensor_options); !made) return tl::unexpected(made.error());
  if (!remote.empty())
    if (auto made = bind(sockets.remote_sensor.emplace(), Type::xpub, remote, sensor_options); !made) return tl::unexpected(made.error());
  if (auto made = bind(sockets.state, Type::xpub, or_default(options.state_endpoints, "state"), {options.state_high_water_mark, kMaxSubscriptionBytes, guard, curve}); !made)
    return tl::unexpected(made.error());
  if (auto made = bind(sockets.control, Type::router, or_default(options.control_endpoints, "control"), {ControlSocket::kHighWaterMark, ControlSocket::kMaxRequestBytes, guard, curve}); !made)
    return tl::unexpected(made.error());
  return sockets;
}

Result<std::unique_ptr<Publisher>> Publisher::start(const PublishOptions& options, std::uint64_t session, ControlHandler control) {
  auto sockets = open_sockets(options);
  if (!sockets) return tl::unexpected(sockets.error());
  return std::unique_ptr<Publisher>(new Publisher(options, session, std::move(control), std::move(*sockets)));
}

Publisher::Publisher(const PublishOptions& options, std::uint64_t session, ControlHandler control, Sockets sockets)
    : options_(options),
      coding_(options.vertices == "int16" ? wire::VertexCoding::kInt16 : wire::VertexCoding::kFloat32),
      started_(monotonic_now()),
      session_(session),
      handler_(std::move(control)),
      context_(std::move(sockets.context)),
      sensor_(std::move(sockets.sensor), session),
      state_(std::move(sockets.state), session),
      remote_sensor_(sockets.remote_sensor ? std::optional<Outlet>(std::in_place, std::move(*sockets.remote_sensor), session) : std::nullopt),
      control_(std::move(sockets.control)),
      gate_(std::move(sockets.gate)),
      guard_(std::move(sockets.guard)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Publisher::~Publisher() { stop(); }

void Publisher::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  inbox_.wake();
  thread_.join();
}

void Publisher::run(const std::stop_token& stop) {
  const auto period = std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(options_.heartbeat_s));
  Nanoseconds next_heartbeat = monotonic_now() + period;
  std::vector<zmq::pollitem_t> items = {{sensor_.socket().handle(), 0, ZMQ_POLLIN, 0},
                                        {state_.socket().handle(), 0, ZMQ_POLLIN, 0},
                                        {control_.socket().handle(), 0, ZMQ_POLLIN, 0},
                                        {nullptr, inbox_.wake_file(), ZMQ_POLLIN, 0}};
  if (remote_sensor_) items.push_back({remote_sensor_->socket().handle(), 0, ZMQ_POLLIN, 0});
  for (zmq::socket_t* monitor : guard_->monitors()) items.push_back({monitor->handle(), 0, ZMQ_POLLIN, 0});
  while (!stop.stop_requested()) {
    cut_revoked();
    Nanoseconds next = serve_at_ ? std::min(*serve_at_, next_heartbeat) : next_heartbeat;
    if (is_cut_) next = std::min(next, monotonic_now() + kBindAgain);
    const auto wait = std::max(Nanoseconds(0), next - monotonic_now());
    zmq::poll(items, std::chrono::duration_cast<std::chrono::milliseconds>(wait) + std::chrono::milliseconds(1));
    guard_->read();  // before the subscriptions, which it is told of
    sensor_.read_subscriptions(*guard_, [](const std::string&) {});
    if (remote_sensor_) remote_sensor_->read_subscriptions(*guard_, [](const std::string&) {});
    state_.read_subscriptions(*guard_, [this](const std::string& prefix) { joined(prefix); });
    send_content();
    control_.read([this](PeerRequest request) { take_request(std::move(request)); });
    if (serve_at_ && monotonic_now() >= *serve_at_) serve_late_joiners();
    if (monotonic_now() < next_heartbeat) continue;
    heartbeat();
    next_heartbeat = monotonic_now() + period;
  }
  send_content();
  send_daemon_status("stopping");
}

void Publisher::cut_revoked() {
  std::vector<BoundSocket*> sockets{&state_.bound(), &control_.bound()};
  if (remote_sensor_) sockets.push_back(&remote_sensor_->bound());
  if (gate_ && gate_->take_revoked()) {
    for (BoundSocket* socket : sockets) socket->cut_remote();
    is_cut_ = true;
    return;  // what is bound again at once would only be refused
  }
  if (!is_cut_) return;
  is_cut_ = false;
  for (BoundSocket* socket : sockets)
    if (!socket->bind_again()) is_cut_ = true;
}

void Publisher::send_content() {
  Inbox::Content content = inbox_.take();
  for (const auto& [name, frame] : content.frames) {
    dropped_ += frame.dropped;
    send_frame(frame, sensor_, false);
    if (remote_sensor_) send_frame(frame, *remote_sensor_, options_.remote_depth == "zstd");
  }
  for (const auto& [name, scene] : content.scenes) take_scene(scene, content.lost[name]);
  for (const auto& [name, shadow] : content.shadows) send_shadow(shadow);
  for (auto& [name, status] : content.statuses) {
    const std::string topic = wire::status_topic(name);
    if (state_.demand().wants(topic)) state_.send(topic, status, {});
    statuses_[name] = std::move(status);
  }
  for (PeerReply& reply : content.replies) send_reply(std::move(reply));
  if (!state_.demand().wants(wire::kLogTopic)) return;
  for (const v1::LogRecord& record : content.log) state_.send(std::string(wire::kLogTopic), record, {});
}

/// Where zstd has no memory left it goes as it is.
Outlet::Blob Publisher::compressed_depth(const Frame& frame) {
  const auto pixels = wire::depth_blob(frame);
  const auto bytes = std::make_shared<std::string>();
  if (!zstd_.append({reinterpret_cast<const char*>(pixels.data()), pixels.size()}, *bytes)) return {};
  return {wire::as_bytes(*bytes), bytes, v1::Envelope::ENCODING_ZSTD};
}

void Publisher::send_frame(const Latest<FramePtr>& latest, Outlet& outlet, bool compress_depth) {
  const Frame& frame = *latest.value;
  const auto wanted = [&](const std::string& topic) { return outlet.demand().wants(topic); };
  if (const std::string topic = wire::sensor_topic(frame.sensor, "depth"); wanted(topic)) {
    v1::DepthImage message;
    wire::fill_depth(frame, message);
    Outlet::Blob blob = compress_depth ? compressed_depth(frame) : Outlet::Blob();
    if (blob.bytes.empty()) blob = {wire::depth_blob(frame), latest.value};
    outlet.send(topic, message, frame.stamps, latest.dropped, std::move(blob));
  }
  if (const std::string topic = wire::sensor_topic(frame.sensor, "color"); !frame.color.empty() && wanted(topic)) {
    v1::ColorImage message;
    wire::fill_color(frame, message);
    outlet.send(topic, message, frame.stamps, latest.dropped, {wire::color_blob(frame), latest.value});
  }
  if (const std::string topic = wire::sensor_topic(frame.sensor, "camera"); wanted(topic)) {
    v1::CameraInfo message;
    wire::fill_camera(frame, message);
    outlet.send(topic, message, frame.stamps, latest.dropped);
  }
}

void Publisher::take_scene(const Latest<ScenePtr>& latest, const std::set<std::uint64_t>& lost) {
  const Scene& scene = *latest.value;
  LastScene& last = last_scenes_[scene.sensor];
  const bool is_history = last.scene && last.scene->sequence > scene.sequence && last.scene->stamps.monotonic >= scene.stamps.monotonic;
  if (is_history) return;  // finished out of order
  last.scene = latest.value;
  last.sent = monotonic_now();
  for (const std::uint64_t id : lost) last.lost[id] = last.sent;
  for (const SceneObject& object : scene.objects) last.lost.erase(object.id);
  std::erase_if(last.lost, [&](const auto& entry) { return last.sent - entry.second > kTellLost; });
  ++scenes_;
  dropped_ += latest.dropped;
  for (const SceneObject& object : scene.objects) send_topology(object.model);
  send_scene(scene, latest.dropped, lost);
}

void Publisher::send_scene(const Scene& scene, std::uint64_t dropped, const std::set<std::uint64_t>& lost) {
  if (state_.demand().wants(wire::kSceneTopic)) {
    v1::Scene message;
    wire::fill(scene, coding_, message);
    state_.send(std::string(wire::kSceneTopic), message, scene.stamps, dropped);
  }
  if (!state_.demand().wants_below(wire::kObjectsPrefix)) return;
  for (const SceneObject& object : scene.objects) {
    const std::string topic = wire::object_topic(object.id);
    if (!state_.demand().wants(topic)) continue;
    v1::ObjectUpdate message;
    wire::fill(scene, object, coding_, message);
    state_.send(topic, message, scene.stamps);
  }
  for (const std::uint64_t id : lost) send_lost(scene, id);
}

void Publisher::send_lost(const Scene& scene, std::uint64_t id) {
  const std::string topic = wire::object_topic(id);
  if (!state_.demand().wants(topic)) return;
  v1::ObjectUpdate message;
  wire::fill_lost(scene, id, message);
  state_.send(topic, message, scene.stamps);
}

void Publisher::send_shadow(const Latest<ScenePtr>& shadow) {
  const Scene& scene = *shadow.value;
  const std::string topic = wire::shadow_topic(scene.profile);
  if (!state_.demand().wants(topic)) return;
  for (const SceneObject& object : scene.objects) send_topology(object.model);
  v1::Scene message;
  wire::fill(scene, coding_, message);
  state_.send(topic, message, scene.stamps, shadow.dropped);
}

void Publisher::repeat_scenes(Nanoseconds not_since) {
  for (auto& [name, last] : last_scenes_) {
    if (last.sent > not_since) continue;
    send_scene(*last.scene, 0, {});
    last.sent = monotonic_now();
  }
}

void Publisher::send_topology(const FittedModel& model) {
  if (!model.topology) return;
  const auto [entry, is_new] = topologies_.try_emplace(model.topology->hash);
  KnownTopology& known = entry->second;
  known.last_used = scenes_;
  if (!is_new) return;
  known.topology = model.topology;
  known.vertices = model.vertices.size();
  send_topologies(wire::mesh_topic(model.topology->hash));
  if (topologies_.size() <= kMaxTopologies) return;
  topologies_.erase(std::min_element(topologies_.begin(), topologies_.end(),
                                     [](const auto& a, const auto& b) { return a.second.last_used < b.second.last_used; }));
}

void Publisher::send_topologies(std::string_view below) {
  if (!state_.demand().wants_below(wire::kMeshPrefix)) return;
  for (const auto& [hash, known] : topologies_) {
    const std::string topic = wire::mesh_topic(hash);
    if (!topic.starts_with(below) || !state_.demand().wants(topic)) continue;
    v1::Topology message;
    wire::fill(*known.topology, known.vertices, message);
    state_.send(topic, message, {});
  }
}

void Publisher::send_daemon_status(const char* state) {
  const std::string topic = wire::status_topic("gfpd");
  if (state_.demand().wants(topic)) state_.send(topic, daemon_status(state), {});
}

v1::DaemonStatus Publisher::daemon_status(const char* state) const {
  v1::DaemonStatus status;
  status.set_version(std::string(version()));
  status.set_state(state);
  status.set_uptime_s(std::chrono::duration<double>(monotonic_now() - started_).count());
  status.set_scenes(scenes_);
  std::size_t objects = 0;
  for (const auto& [name, last] : last_scenes_) objects += last.scene->objects.size();
  status.set_objects(static_cast<std::uint32_t>(objects));
  const auto remote = [&](auto figure) { return remote_sensor_ ? figure(*remote_sensor_) : 0; };
  status.set_messages(sensor_.messages() + state_.messages() + remote([](const Outlet& outlet) { return outlet.messages(); }));
  status.set_bytes(sensor_.bytes() + state_.bytes() + remote([](const Outlet& outlet) { return outlet.bytes(); }));
  status.set_dropped(dropped_);
  status.set_subscriptions(static_cast<std::uint32_t>(sensor_.demand().size() + state_.demand().size() + remote([](const Outlet& outlet) { return outlet.demand().size(); })));
  status.set_refused(guard_->refused());
  status.set_connections(static_cast<std::uint32_t>(guard_->connections()));
  return status;
}

void Publisher::heartbeat() {
  guard_->prune();
  send_daemon_status("running");
  send_topologies(wire::kMeshPrefix);
  for (const auto& [name, status] : statuses_)
    if (const std::string topic = wire::status_topic(name); state_.demand().wants(topic)) state_.send(topic, status, {});
  repeat_scenes(monotonic_now() - std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(options_.heartbeat_s)));
}

void Publisher::joined(const std::string& prefix) {
  const auto concerns = [&](std::string_view topics) { return prefix.starts_with(topics) || topics.starts_with(prefix); };
  if (!concerns(wire::kMeshPrefix) && !concerns(wire::kSceneTopic) && !concerns(wire::kObjectsPrefix)) return;
  joined_ = monotonic_now();
  if (!serve_at_) serve_at_ = std::max(joined_, served_ + kMinRepeat);
}

void Publisher::serve_late_joiners() {
  send_topologies(wire::kMeshPrefix);
  repeat_scenes(joined_);  // a scene that was sent since then has reached them
  for (const auto& [name, last] : last_scenes_)
    for (const auto& [id, since] : last.lost) send_lost(*last.scene, id);
  served_ = monotonic_now();
  serve_at_.reset();
}

}  // namespace gfp
