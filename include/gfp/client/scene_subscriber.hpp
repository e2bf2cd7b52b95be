#pragma once

#include <chrono>
#include <map>
#include <memory>

#include "gfp/client/subscriber.hpp"
#include "gfp/scene/scene.hpp"

namespace gfp {

/// Scenes as plain data: subscribes to /gfp/scene/ and the meshes' topologies and puts them together again. An object whose
/// topology has not arrived yet (for at most a second after joining) has one without triangles. One thread at a time.
class SceneSubscriber {
 public:
  /// Errors: as Subscriber::connect().
  static Result<SceneSubscriber> connect(const SubscriberOptions& options = {});

  /// The next scene. Errors: kTimeout; kCorruptData, kTooLarge (one message was skipped: ask again).
  Result<Scene> next(std::chrono::milliseconds timeout);
  const SubscriberCounts& counts() const { return subscriber_.counts(); }
  double silent_for_s() const { return subscriber_.silent_for_s(); }

 private:
  explicit SceneSubscriber(Subscriber subscriber) : subscriber_(std::move(subscriber)) {}
  Result<void> keep_topology(const Message& message);

  static constexpr std::size_t kMaxTopologies = 1024;
  Subscriber subscriber_;
  std::map<std::uint64_t, std::shared_ptr<const Topology>> topologies_;
};

/// Every object has the triangles of its mesh.
bool has_all_meshes(const Scene& scene);

}  // namespace gfp
