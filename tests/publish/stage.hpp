#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "gfp/client/control_client.hpp"
#include "publish/publisher.hpp"
#include "support/hand_made_scene.hpp"
#include "support/temporary_folder.hpp"

namespace gfp::test {

constexpr std::chrono::seconds kLong{20};  // a deadline, not a wait: tests end with the message they expect

/// A publisher with endpoints of its own, and what subscribes to it.
struct Stage {
  TemporaryFolder folder;
  PublishOptions options;
  SubscriberOptions subscriber;
  std::unique_ptr<Publisher> publisher;

  explicit Stage(double heartbeat_s = 0.05) {
    options.sensor_endpoints = {"ipc://" + (folder / "sensor").string()};
    options.state_endpoints = {"ipc://" + (folder / "state").string()};
    options.control_endpoints = {"ipc://" + (folder / "control").string()};
    options.heartbeat_s = heartbeat_s;
    subscriber.endpoints = {options.sensor_endpoints[0], options.state_endpoints[0]};
    start(1);
  }
  void start(std::uint64_t session) {
    publisher.reset();
    auto started = Publisher::start(options, session);
    ASSERT_TRUE(started.has_value()) << started.error().what;
    publisher = std::move(*started);
  }
  ControlClient control() const {
    auto client = ControlClient::connect({options.control_endpoints[0], kLong, {}});
    EXPECT_TRUE(client.has_value());
    return std::move(*client);
  }
};

inline ScenePtr shared(Scene scene) { return std::make_shared<const Scene>(std::move(scene)); }

/// A scene that is newer than those of smaller numbers.
inline ScenePtr numbered_scene(std::uint64_t sequence, int objects = 2) {
  Scene scene = hand_made_scene(objects);
  scene.sequence = sequence;
  scene.stamps.monotonic = Nanoseconds(static_cast<std::int64_t>(sequence));
  return shared(std::move(scene));
}

}  // namespace gfp::test
