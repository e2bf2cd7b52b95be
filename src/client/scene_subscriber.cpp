#include "gfp/client/scene_subscriber.hpp"

#include <algorithm>

#include "wire/bounded_parse.hpp"
#include "wire/scene_messages.hpp"
#include "wire/topics.hpp"

namespace gfp {

Result<SceneSubscriber> SceneSubscriber::connect(const SubscriberOptions& options) {
  auto subscriber = Subscriber::connect({std::string(wire::kMeshPrefix), std::string(wire::kSceneTopic)}, options);
  if (!subscriber) return tl::unexpected(subscriber.error());
  return SceneSubscriber(std::move(*subscriber));
}

Result<Scene> SceneSubscriber::next(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (true) {
    const auto left = std::max(std::chrono::milliseconds(0), std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()));
    const auto message = subscriber_.receive(left);
    if (!message) return tl::unexpected(message.error());
    if (message->schema == v1::Topology::descriptor()->full_name()) {
      if (auto kept = keep_topology(*message); !kept) return tl::unexpected(kept.error());
    } else if (message->schema == v1::Scene::descriptor()->full_name()) {
      v1::Scene scene;
      if (auto parsed = wire::parse_bounded(wire::as_bytes(message->payload), wire::kMaxSceneBytes, scene); !parsed) return tl::unexpected(parsed.error());
      return wire::scene_from(scene, [this](std::uint64_t hash) {
        const auto known = topologies_.find(hash);
        return known == topologies_.end() ? nullptr : known->second;
      });
    }
  }
}

Result<void> SceneSubscriber::keep_topology(const Message& message) {
  v1::Topology sent;
  if (auto parsed = wire::parse_bounded(wire::as_bytes(message.payload), wire::kMaxTopologyBytes, sent); !parsed) return parsed;
  if (topologies_.contains(sent.hash())) return {};  // repeated every second; equal hash, equal content
  auto topology = wire::topology_from(sent);
  if (!topology) return tl::unexpected(topology.error());
  if (topologies_.size() >= kMaxTopologies) topologies_.clear();  // they come again within a second
  topologies_[sent.hash()] = std::make_shared<const Topology>(std::move(*topology));
  return {};
}

bool has_all_meshes(const Scene& scene) {
  return std::all_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) { return !object.model.topology->triangles.empty(); });
}

}  // namespace gfp
