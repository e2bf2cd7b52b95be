#include "view/hub.hpp"

#include <fmt/format.h>

#include "wire/bounded_parse.hpp"
#include "wire/foxglove_messages.hpp"
#include "wire/scene_messages.hpp"
#include "wire/schema.hpp"
#include "wire/topics.hpp"

namespace gfp::view {
namespace {

constexpr std::uint32_t kRetypeService = 1;

std::uint64_t log_time(Nanoseconds stamp) { return static_cast<std::uint64_t>(stamp.count() > 0 ? stamp.count() : realtime_now().count()); }

}  // namespace

Hub::Hub(std::string name, std::uint64_t session, std::shared_ptr<ReplayControl> playback, Ask ask)
    : name_(std::move(name)), session_(session), playback_(std::move(playback)), ask_(std::move(ask)) {
  for (const Stream stream : {Stream::kScene, Stream::kMesh, Stream::kMarkers, Stream::kStatus, Stream::kLog}) channel_for(stream, "");
}

Hub::Entry& Hub::channel_for(Stream stream, const std::string& name) {
  const auto [place, is_new] = channels_.try_emplace({stream, name});
  Entry& entry = place->second;
  if (!is_new) return entry;
  struct Kind {
    std::string topic;
    const google::protobuf::Descriptor* schema;
  };
  const auto kind = [&]() -> Kind {
    switch (stream) {
      case Stream::kScene: return {std::string(wire::kSceneTopic), v1::Scene::descriptor()};
      case Stream::kMesh: return {std::string(wire::kMeshPrefix), v1::Topology::descriptor()};
      case Stream::kMarkers: return {"/gfp/markers/", foxglove::SceneUpdate::descriptor()};
      case Stream::kStatus: return {std::string(wire::kStatusPrefix), v1::SensorStatus::descriptor()};
      case Stream::kLog: return {std::string(wire::kLogTopic), foxglove::Log::descriptor()};
      case Stream::kDepth: return {wire::sensor_topic(name, "depth"), foxglove::RawImage::descriptor()};
      case Stream::kColor: return {wire::sensor_topic(name, "color"), foxglove::RawImage::descriptor()};
      case Stream::kCamera: return {wire::sensor_topic(name, "camera"), foxglove::CameraCalibration::descriptor()};
      case Stream::kCloud: return {wire::sensor_topic(name, "cloud"), foxglove::PointCloud::descriptor()};
      case Stream::kShadow: return {wire::shadow_topic(name), v1::Scene::descriptor()};
      case Stream::kTransforms: return {wire::sensor_topic(name, "transforms"), foxglove::FrameTransforms::descriptor()};
    }
    return {};
  }();
  entry = {stream, name, {static_cast<std::uint32_t>(channels_.size()), kind.topic, kind.schema->full_name(), wire::descriptor_set(*kind.schema)}};
  by_id_[entry.channel.id] = &entry;
  for (Client* client : clients_) client->send_text(advertise(std::span(&entry.channel, 1)));
  return entry;
}

void Hub::join(Client& client) {
  clients_.insert(&client);
  std::optional<PlaybackRange> range;
  if (playback_) {
    const ReplayControl::State state = playback_->state();
    range = {state.begin, state.begin + state.duration, state.paused, state.speed};
  }
  client.send_text(server_info(name_, session_, range, ask_ != nullptr));
  std::vector<Channel> all;
  for (const auto& [id, entry] : by_id_) all.push_back(entry->channel);
  client.send_text(advertise(all));
  if (!ask_) return;
  const auto *request = v1::RetypeRequest::descriptor(), *response = v1::Retyped::descriptor();
  const Service retype{kRetypeService, "/gfp/primitive/retype", request->full_name(), wire::descriptor_set(*request), response->full_name(), wire::descriptor_set(*response)};
  client.send_text(advertise_services(std::span(&retype, 1)));
}

void Hub::leave(Client& client) {
  clients_.erase(&client);
  std::erase_if(calls_, [&](const auto& entry) { return entry.second.client == &client; });
}

void Hub::heard(Client& client, std::string_view text) {
  const auto complain = [&](const std::string& what) { client.send_text(status(StatusLevel::kError, what)); };
  const auto message = parse_client_message(text);
  if (!message) return complain(message.error().what);
  if (const auto* subscribe = std::get_if<Subscribe>(&*message)) {
    for (const auto& [subscription, channel] : subscribe->items) {
      const auto found = by_id_.find(channel);
      if (found == by_id_.end()) {
        complain(fmt::format("no channel {}", channel));
        continue;
      }
      if (const auto done = client.subscribe(subscription, channel); !done) complain(done.error().what);
      else send_last(client, *found->second);
    }
  } else if (const auto* unsubscribe = std::get_if<Unsubscribe>(&*message)) {
    for (const std::uint32_t subscription : unsubscribe->subscriptions) client.unsubscribe(subscription);
  } else {
    complain(fmt::format("{}: not offered by this server", std::get<Other>(*message).op));
  }
}

void Hub::heard_binary(Client& client, std::string_view bytes) {
  const auto message = parse_client_binary(bytes);
  if (!message) return client.send_text(status(StatusLevel::kError, message.error().what));
  if (const auto* call = std::get_if<ServiceCall>(&*message)) return this->call(client, *call);
  if (!playback_) return client.send_text(status(StatusLevel::kError, "playback: there is no recording to steer"));
  steer(client, std::get<PlaybackRequest>(*message));
}

void Hub::call(Client& client, const ServiceCall& call) {
  const auto refuse = [&](const std::string& why) { client.send_text(service_failure(call.service, call.call, why)); };
  if (!ask_ || call.service != kRetypeService) return refuse(fmt::format("no service {}", call.service));
  if (calls_.size() >= kMaxCalls) return refuse(fmt::format("{} calls wait already", kMaxCalls));
  PeerRequest request;
  request.peer.identity = std::to_string(next_call_++);
  if (auto parsed = wire::parse_bounded(wire::as_bytes(call.payload), kMaxClientMessageBytes, *request.request.mutable_retype()); !parsed) return refuse(parsed.error().what);
  calls_[request.peer.identity] = {&client, call.call};
  ask_(std::move(request));
}

void Hub::answer(const PeerReply& reply) {
  const auto found = calls_.find(reply.peer.identity);
  if (found == calls_.end()) return;  // who asked is gone
  const Call call = found->second;
  calls_.erase(found);
  if (reply.reply.code() != v1::ControlReply::CODE_OK) return call.client->send_text(service_failure(kRetypeService, call.id, reply.reply.error()));
  call.client->send_binary(service_response(kRetypeService, call.id, reply.reply.retyped().SerializeAsString()));
}

/// What one client turns, all learn who have ever asked for something themselves: others do not know the message.
void Hub::steer(Client& client, const PlaybackRequest& request) {
  client.steers_playback = true;
  playback_->set_speed(request.speed);
  if (request.play) playback_->resume();
  else if (!playback_->state().paused) playback_->pause();
  if (request.seek) playback_->seek(*request.seek - playback_->state().begin);  // after a pause: it shows its frame
  PlaybackState now = playback_now();
  now.did_seek = request.seek.has_value();
  told_ = now;
  for (Client* other : clients_)
    if (other->steers_playback && other != &client) other->send_binary(playback_state(now));
  now.request_id = request.id;
  client.send_binary(playback_state(now));
}

PlaybackState Hub::playback_now() const {
  const ReplayControl::State state = playback_->state();
  const PlaybackStatus status = state.ended ? PlaybackStatus::kEnded : state.paused ? PlaybackStatus::kPaused : PlaybackStatus::kPlaying;
  return {status, state.begin + state.position, state.speed, false, {}};
}

/// The time with every frame; the state when it has changed by itself: at the end, by another's hand.
void Hub::tell_playback() {
  const PlaybackState now = playback_now();
  const bool is_news = !told_ || told_->status != now.status || told_->speed != now.speed;
  told_ = now;
  for (Client* client : clients_) {
    client->send_time(time_message(now.time));
    if (is_news && client->steers_playback) client->send_binary(playback_state(now));
  }
}

bool Hub::is_wanted(const Entry& entry) const {
  return std::any_of(clients_.begin(), clients_.end(), [&](const Client* client) { return client->wants(entry.channel.id); });
}

void Hub::take(Inbox::Content content) {
  if (playback_ && (!content.frames.empty() || !content.statuses.empty())) tell_playback();
  for (const PeerReply& reply : content.replies) answer(reply);
  for (const auto& [sensor, frame] : content.frames) take_frame(frame.value);
  for (const auto& [sensor, scene] : content.scenes) take_scene(scene.value);
  for (const auto& [sensor, shadow] : content.shadows) take_shadow(shadow.value);
  for (auto& [sensor, status] : content.statuses) {
    send_status(channel_for(Stream::kStatus, ""), status, nullptr);
    statuses_[sensor] = std::move(status);
  }
  const Entry& log = channel_for(Stream::kLog, "");
  if (!is_wanted(log)) return;
  std::uint64_t line = 0;
  for (const v1::LogRecord& record : content.log) {
    foxglove::Log message;
    wire::fill_log(record, message);
    deliver(log, fmt::format("{} {}", record.stamp_ns(), line++), log_time(Nanoseconds(record.stamp_ns())), message, nullptr);
  }
}

void Hub::take_frame(const FramePtr& frame) {
  frames_[frame->sensor] = frame;
  for (const Stream stream : {Stream::kDepth, Stream::kColor, Stream::kCamera, Stream::kCloud, Stream::kTransforms})
    if (stream != Stream::kColor || !frame->color.empty()) send_frame_stream(channel_for(stream, frame->sensor), *frame, nullptr);
}

void Hub::take_scene(const ScenePtr& scene) {
  take_topologies(*scene);
  scenes_[scene->sensor] = scene;
  for (const Stream stream : {Stream::kScene, Stream::kMarkers}) send_scene_stream(channel_for(stream, ""), *scene, nullptr);
}

void Hub::take_shadow(const ScenePtr& shadow) {
  take_topologies(*shadow);
  shadows_[shadow->sensor] = shadow;
  send_scene_stream(channel_for(Stream::kShadow, shadow->profile), *shadow, nullptr);
}

void Hub::take_topologies(const Scene& scene) {
  for (const SceneObject& object : scene.objects) {
    if (!object.model.topology) continue;
    const auto [place, is_new] = topologies_.try_emplace(object.model.topology->hash, KnownTopology{object.model.topology, object.model.vertices.size()});
    if (is_new) send_topology(channel_for(Stream::kMesh, ""), place->first, place->second, nullptr);
  }
  if (topologies_.size() > kMaxTopologies) topologies_.clear();  // those in use come again with the next scene
}

void Hub::send_last(Client& client, const Entry& entry) {
  switch (entry.stream) {
    case Stream::kMesh:
      for (const auto& [hash, known] : topologies_) send_topology(entry, hash, known, &client);
      return;
    case Stream::kScene:
    case Stream::kMarkers:
      for (const auto& [sensor, scene] : scenes_) send_scene_stream(entry, *scene, &client);
      return;
    case Stream::kShadow:
      for (const auto& [sensor, shadow] : shadows_)
        if (shadow->profile == entry.name) send_scene_stream(entry, *shadow, &client);
      return;
    case Stream::kStatus:
      for (const auto& [sensor, status] : statuses_) send_status(entry, status, &client);
      return;
    case Stream::kLog: return;
    default:
      if (const auto frame = frames_.find(entry.name); frame != frames_.end()) send_frame_stream(entry, *frame->second, &client);
  }
}

void Hub::send_frame_stream(const Entry& entry, const Frame& frame, Client* only) {
  if (only == nullptr && !is_wanted(entry)) return;
  const std::uint64_t time = log_time(frame.stamps.realtime);
  const auto send = [&](auto message, auto fill) {
    fill(frame, message);
    deliver(entry, "", time, message, only);
  };
  switch (entry.stream) {
    case Stream::kDepth: return send(foxglove::RawImage(), wire::fill_depth_image);
    case Stream::kColor: return send(foxglove::RawImage(), wire::fill_color_image);
    case Stream::kCamera: return send(foxglove::CameraCalibration(), wire::fill_calibration);
    case Stream::kCloud: return send(foxglove::PointCloud(), wire::fill_cloud);
    default: return send(foxglove::FrameTransforms(), wire::fill_transforms);
  }
}

void Hub::send_scene_stream(const Entry& entry, const Scene& scene, Client* only) {
  if (only == nullptr && !is_wanted(entry)) return;
  const std::uint64_t time = log_time(scene.stamps.realtime);
  if (entry.stream == Stream::kMarkers) {
    foxglove::SceneUpdate message;
    wire::fill_scene_update(scene, message);
    return deliver(entry, scene.sensor, time, message, only);
  }
  v1::Scene message;
  wire::fill(scene, wire::VertexCoding::kInt16, message);  // a micrometre is finer than a screen
  deliver(entry, scene.sensor, time, message, only);
}

void Hub::send_topology(const Entry& entry, std::uint64_t hash, const KnownTopology& known, Client* only) {
  if (only == nullptr && !is_wanted(entry)) return;
  v1::Topology message;
  wire::fill(*known.topology, known.vertices, message);
  deliver(entry, fmt::format("{:016x}", hash), log_time({}), message, only);
}

void Hub::send_status(const Entry& entry, const v1::SensorStatus& status, Client* only) {
  if (only == nullptr && !is_wanted(entry)) return;
  deliver(entry, status.sensor(), log_time({}), status, only);
}

void Hub::deliver(const Entry& entry, const std::string& key, std::uint64_t log_time_ns, const google::protobuf::MessageLite& message, Client* only) {
  const bool is_image = entry.stream == Stream::kDepth || entry.stream == Stream::kColor || entry.stream == Stream::kCloud;
  const auto kind = is_image ? ClientQueue::Class::kSensor : ClientQueue::Class::kState;
  const auto payload = std::make_shared<const std::string>(message.SerializeAsString());
  const Nanoseconds now = monotonic_now();
  for (Client* client : clients_)
    if ((only == nullptr || only == client) && client->wants(entry.channel.id)) client->send(kind, entry.channel.id, key, log_time_ns, payload, now);
}

}  // namespace gfp::view
