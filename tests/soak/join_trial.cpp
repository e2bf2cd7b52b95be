#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "gfp/client/control_client.hpp"
#include "gfp/core/random.hpp"
#include "gfp/v1/scene.pb.h"
#include "publish/publisher.hpp"
#include "soak/service_trials.hpp"
#include "support/hand_made_scene.hpp"
#include "support/temporary_folder.hpp"

namespace gfp::test {
namespace {

using namespace std::chrono_literals;

/// A publisher whose world changes a few hundred times a second: objects come, change and go, and nothing is repeated on its own account.
class ChangingWorld {
 public:
  ChangingWorld() {
    options_.sensor_endpoints = {"ipc://" + (folder_ / "sensor").string()};
    options_.state_endpoints = {"ipc://" + (folder_ / "state").string()};
    options_.control_endpoints = {"ipc://" + (folder_ / "control").string()};
    options_.heartbeat_s = 60;
    publisher_ = std::move(*Publisher::start(options_, 1));
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        std::this_thread::sleep_for(std::chrono::microseconds(500 + random_.below(5000)));
        const std::lock_guard lock(mutex_);
        if (!holds_) change();
      }
    });
  }
  const PublishOptions& options() const { return options_; }

  /// The world as it is from now on, until go_on().
  std::shared_ptr<const Scene> hold() {
    const std::lock_guard lock(mutex_);
    holds_ = true;
    change();
    return last_;
  }
  void go_on() {
    const std::lock_guard lock(mutex_);
    holds_ = false;
  }

 private:
  void change() {
    Scene scene = hand_made_scene(1, ++sequence_);
    const SceneObject some = scene.objects.at(0);
    scene.objects.clear();
    scene.lost.clear();
    for (std::uint64_t id = 1; id <= 6; ++id) {
      const bool was = present_.contains(id), is = random_.below(8) == 0 ? !was : was;
      if (is) {
        SceneObject object = some;
        object.id = id;
        object.pixels = static_cast<int>(sequence_ * 10 + id);
        scene.objects.push_back(std::move(object));
        present_.insert(id);
      } else if (was) {
        scene.lost.push_back(id);
        present_.erase(id);
      }
    }
    scene.sequence = sequence_;
    scene.stamps.monotonic = Nanoseconds(static_cast<std::int64_t>(sequence_));
    last_ = std::make_shared<const Scene>(std::move(scene));
    publisher_->put(last_);
  }

  TemporaryFolder folder_;
  PublishOptions options_;
  std::unique_ptr<Publisher> publisher_;
  std::mutex mutex_;
  bool holds_ = false;
  std::uint64_t sequence_ = 0;
  std::set<std::uint64_t> present_;
  std::shared_ptr<const Scene> last_;
  Random random_{1};
  std::jthread thread_;  ///< Last: it uses all of the above.
};

/// What a client believes, from the objects' topics alone and from the scene's; older state than it has is a failure.
struct Belief {
  std::map<std::uint64_t, int> pixels_of;  ///< By object.
  std::map<std::string, std::uint64_t> sequence_of;  ///< By topic.
  std::map<std::uint64_t, int> scene;
  std::map<std::string, std::uint64_t> from;  ///< What the snapshot holds already.
  std::string failure;

  void apply(const std::string& topic, const std::string& payload) {
    std::uint64_t sequence = 0;
    if (topic == "/gfp/scene/") {
      v1::Scene message;
      if (!message.ParseFromString(payload)) failure = "an unreadable scene";
      sequence = message.header().sequence();
      scene.clear();
      for (const auto& object : message.objects()) scene[object.id()] = static_cast<int>(object.pixels());
    } else {
      v1::ObjectUpdate message;
      if (!message.ParseFromString(payload)) failure = "an unreadable object";
      sequence = message.header().sequence();
      if (message.object().status() == v1::SceneObject::STATUS_LOST) pixels_of.erase(message.object().id());
      else pixels_of[message.object().id()] = static_cast<int>(message.object().pixels());
    }
    if (sequence < sequence_of[topic]) failure = topic + ": frame " + std::to_string(sequence) + " after " + std::to_string(sequence_of[topic]);
    sequence_of[topic] = sequence;
  }
  void apply(const Message& message) {
    const auto known = from.find(message.topic);
    if (known == from.end() || message.seq >= known->second) apply(message.topic, message.payload);
  }
};

}  // namespace

Trial join_trial(std::uint64_t number) {
  static ChangingWorld world;
  Random random(number + 1);
  Trial trial;
  SubscriberOptions options;
  options.endpoints = world.options().state_endpoints;
  auto subscriber = Subscriber::connect({"/gfp/scene/", "/gfp/objects/"}, options);
  std::this_thread::sleep_for(std::chrono::microseconds(random.below(3000)));
  auto control = ControlClient::connect({world.options().control_endpoints[0], 20s, {}});
  const auto snapshot = control->snapshot();
  if (!snapshot) return {"no snapshot: " + snapshot.error().what, {}};
  Belief mine;
  for (const TopicState& topic : snapshot->topics) {
    mine.from[topic.topic] = topic.next_seq;
    if (topic.topic == "/gfp/scene/" || topic.topic.starts_with("/gfp/objects/")) mine.apply(topic.topic, topic.payload);
  }
  const auto listen_for = [&](Nanoseconds patience, const auto& done) {
    const Nanoseconds end = monotonic_now() + patience;
    while (!done() && monotonic_now() < end)
      if (const auto message = subscriber->receive(5ms)) mine.apply(*message);
  };
  listen_for(Nanoseconds(random.below(15'000'000)), [] { return false; });
  const auto truth = world.hold();
  std::map<std::uint64_t, int> expected;
  for (const SceneObject& object : truth->objects) expected[object.id] = object.pixels;
  const Nanoseconds held = monotonic_now();
  listen_for(Nanoseconds(5'000'000'000), [&] { return mine.scene == expected && mine.pixels_of == expected; });
  trial.measured("converged_after_ms", std::chrono::duration<double, std::milli>(monotonic_now() - held).count());
  world.go_on();
  if (mine.scene != expected) trial.failure = "the scene is not that of the publisher";
  else if (mine.pixels_of != expected) trial.failure = "of " + std::to_string(expected.size()) + " objects " + std::to_string(mine.pixels_of.size()) + " are believed, or others";
  if (!mine.failure.empty()) trial.failure = mine.failure;
  return trial;
}

}  // namespace gfp::test
