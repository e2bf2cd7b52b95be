// The publisher's side of the control socket: it answers what it knows itself, the state that it publishes.
#include "publish/publisher.hpp"
#include "wire/scene_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {

void Publisher::take_request(PeerRequest request) {
  if (request.request.has_snapshot()) return send_reply({request.peer, snapshot(request.request)});
  if (!handler_) return send_reply({request.peer, refusal(request.request, v1::ControlReply::CODE_UNAVAILABLE, "this publisher has no daemon behind it")});
  handler_(std::move(request));
}

void Publisher::send_reply(PeerReply reply) {
  reply.reply.set_session(session_);
  control_.send(reply);
}

v1::ControlReply Publisher::snapshot(const v1::ControlRequest& request) const {
  v1::ControlReply reply;
  reply.set_id(request.id());
  v1::Snapshot& snapshot = *reply.mutable_snapshot();
  const std::string& prefix = request.snapshot().prefix();
  // `fill` makes the payload, and only where the topic is asked for.
  const auto add = [&](const std::string& topic, auto message, const auto& fill) {
    if (!topic.starts_with(prefix)) return;
    fill(message);
    v1::Snapshot::Entry& entry = *snapshot.add_entries();
    entry.set_topic(topic);
    entry.set_schema(message.GetTypeName());
    entry.set_next_seq(state_.next_seq(topic));
    entry.set_payload(message.SerializeAsString());
  };
  for (const auto& [hash, known] : topologies_)
    add(wire::mesh_topic(hash), v1::Topology(), [&, &topology = known](v1::Topology& message) { wire::fill(*topology.topology, topology.vertices, message); });
  for (const auto& [sensor, last] : last_scenes_) {
    const Scene& scene = *last.scene;
    for (const SceneObject& object : scene.objects)
      add(wire::object_topic(object.id), v1::ObjectUpdate(), [&](v1::ObjectUpdate& message) { wire::fill(scene, object, coding_, message); });
    add(std::string(wire::kSceneTopic), v1::Scene(), [&](v1::Scene& message) { wire::fill(scene, coding_, message); });
  }
  add(wire::status_topic("gfpd"), v1::DaemonStatus(), [&](v1::DaemonStatus& message) { message = daemon_status("running"); });
  for (const auto& [sensor, status] : statuses_) add(wire::status_topic(sensor), v1::SensorStatus(), [&, &last = status](v1::SensorStatus& message) { message = last; });
  return reply;
}

}  // namespace gfp
