#include "publish/publisher.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <functional>

#include "gfp/client/scene_subscriber.hpp"
#include "gfp/core/random.hpp"
#include "gfp/v1/status.pb.h"
#include "publish/stage.hpp"
#include "wire/scene_json.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

using test::kLong;
using test::shared;
using test::Stage;

/// The next message that `wanted` accepts; `push` is called again and again until it comes.
template <class Wanted>
Result<Message> wait_for(Subscriber& subscriber, Wanted&& wanted, const std::function<void()>& push = [] {}) {
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (std::chrono::steady_clock::now() < deadline) {
    push();
    auto message = subscriber.receive(100ms);
    if (message && wanted(*message)) return message;
  }
  return failure(ErrorCode::kTimeout, "no such message");
}

// The end-to-end claim: what was put in comes out, mesh and grasps, for a subscriber that came late.
TEST(Publisher, ALateSubscriberGetsTheSceneWithItsMeshes) {
  Stage stage;
  const Scene scene = test::hand_made_scene(3);
  stage.publisher->put(shared(scene));
  auto subscriber = SceneSubscriber::connect(stage.subscriber);
  ASSERT_TRUE(subscriber.has_value()) << subscriber.error().what;
  Result<Scene> received = failure(ErrorCode::kTimeout, "");
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (std::chrono::steady_clock::now() < deadline && !(received && has_all_meshes(*received))) received = subscriber->next(100ms);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(scene_json(*received).dump(), scene_json(scene).dump());
}

TEST(Publisher, ObjectsHaveTopicsOfTheirOwnAndSayWhenTheyAreLost) {
  Stage stage(30);  // no repetition within the test
  auto subscriber = Subscriber::connect({"/gfp/objects/2/", "/gfp/objects/77/"}, stage.subscriber);
  ASSERT_TRUE(subscriber.has_value());
  const Scene scene = test::hand_made_scene(3);  // 77 and 99 are lost in it
  stage.publisher->put(shared(scene));
  std::uint64_t sequence = scene.sequence;
  bool updated = false, lost = false;  // in whichever order the topics come
  const auto both = wait_for(*subscriber, [&](const Message& m) {
    if (m.topic == "/gfp/objects/77/") lost = true;
    if (m.topic == "/gfp/objects/2/") {
      updated = true;
      EXPECT_EQ(m.schema, "gfp.v1.ObjectUpdate");
      EXPECT_EQ(m.stamps.sensor, scene.stamps.sensor);
      Scene next = test::hand_made_scene(3);  // the subscription to 77 may have come after the first
      next.sequence = ++sequence;
      if (!lost) stage.publisher->put(shared(next));
    }
    return updated && lost;
  });
  EXPECT_TRUE(both.has_value()) << "updated " << updated << ", lost " << lost;
}

TEST(Publisher, DepthTravelsWithItsPixels) {
  Stage stage;
  auto subscriber = Subscriber::connect({"/gfp/sensor/front/depth/"}, stage.subscriber);
  ASSERT_TRUE(subscriber.has_value());
  auto frame = std::make_shared<Frame>();
  frame->sensor = "front";
  frame->depth.pixels = Image<std::uint16_t>(640, 480, 1234);
  frame->depth.pixels.at(639, 479) = 4321;
  Result<Message> message = failure(ErrorCode::kTimeout, "");
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (!message && std::chrono::steady_clock::now() < deadline) {  // frames are not repeated: until the subscription is known
    stage.publisher->put(FramePtr(frame));
    message = subscriber->receive(20ms);
  }
  ASSERT_TRUE(message.has_value());
  const auto depth = depth_image(*message);
  ASSERT_TRUE(depth.has_value()) << depth.error().what;
  EXPECT_EQ(depth->pixels.pixels, frame->depth.pixels.pixels);
}

// seq has no gap on the sender's side, whatever it dropped before the socket; what it dropped it says.
// Over tcp a frame costs a third of the bytes, and is the same frame.
TEST(Publisher, DepthTravelsCompressedOverTcp) {
  for (const std::string coding : {"zstd", "raw"}) {
    Stage stage;
    stage.options.insecure = true;
    stage.options.remote_depth = coding;
    const std::string tcp = "tcp://127.0.0.1:" + std::to_string(40'000 + getpid() % 10'000);
    stage.options.sensor_endpoints.push_back(tcp);
    stage.start(2);
    Random random(5);
    auto frame = std::make_shared<Frame>();
    frame->sensor = "front";
    frame->depth.scale_m = 0.001;
    frame->depth.pixels = Image<std::uint16_t>(320, 240);
    for (std::size_t i = 0; i < frame->depth.pixels.pixels.size(); ++i) frame->depth.pixels.pixels[i] = static_cast<std::uint16_t>(800 + i / 320 + random.below(3));
    const auto receive = [&](const std::string& endpoint) {
      SubscriberOptions options;
      options.endpoints = {endpoint};
      auto subscriber = Subscriber::connect({"/gfp/sensor/front/depth/"}, options);
      const auto message = wait_for(*subscriber, [&](const Message&) { return true; }, [&] { stage.publisher->put(frame); });
      EXPECT_TRUE(message) << endpoint;
      if (!message) return SubscriberCounts{};
      const auto depth = depth_image(*message);
      EXPECT_TRUE(depth && depth->pixels.pixels == frame->depth.pixels.pixels) << endpoint;
      return subscriber->counts();
    };
    const std::uint64_t local = receive(stage.options.sensor_endpoints[0]).bytes, remote = receive(tcp).bytes;
    EXPECT_GT(local, 2U * 320 * 240);
    if (coding == "zstd") EXPECT_LT(3 * remote, local);
    else EXPECT_EQ(remote, local);
  }
}

TEST(Publisher, SequencesHaveNoGapsAndCarryTheSession) {
  Stage stage;
  auto subscriber = Subscriber::connect({"/gfp/scene/"}, stage.subscriber);
  ASSERT_TRUE(subscriber.has_value());
  std::uint64_t received = 0, last_seq = 0;
  for (std::uint64_t i = 0; received < 20 && i < 100'000; ++i) {
    Scene scene = test::hand_made_scene(1);
    scene.sequence = i;
    scene.stamps.monotonic = Nanoseconds(static_cast<std::int64_t>(i));
    stage.publisher->put(shared(std::move(scene)));
    const auto message = subscriber->receive(1ms);
    if (!message) continue;
    EXPECT_EQ(message->session, 1U);
    if (received > 0) {
      EXPECT_EQ(message->seq, last_seq + 1);
    }
    last_seq = message->seq;
    ++received;
  }
  EXPECT_EQ(received, 20U);
  EXPECT_EQ(subscriber->counts().missed, 0U);
}

TEST(Publisher, ASceneOlderThanTheLastIsHistory) {
  Stage stage(0.02);
  Scene newer = test::hand_made_scene(1), older = test::hand_made_scene(1);
  newer.sequence = 10, older.sequence = 9;
  stage.publisher->put(shared(newer));
  auto subscriber = SceneSubscriber::connect(stage.subscriber);
  ASSERT_TRUE(subscriber->next(kLong).has_value());  // the newer one was taken
  stage.publisher->put(shared(older));
  for (int i = 0; i < 5; ++i) {
    const auto scene = subscriber->next(kLong);
    ASSERT_TRUE(scene.has_value());
    EXPECT_EQ(scene->sequence, 10U);
  }
}

TEST(Publisher, ARestartIsSeenAsANewSession) {
  Stage stage;
  auto subscriber = Subscriber::connect({"/gfp/status/gfpd/"}, stage.subscriber);
  ASSERT_TRUE(wait_for(*subscriber, [](const Message& m) { return m.session == 1; }).has_value());
  stage.start(2);
  ASSERT_TRUE(wait_for(*subscriber, [](const Message& m) { return m.session == 2; }).has_value());
  EXPECT_EQ(subscriber->counts().restarts, 1U);
}

TEST(Publisher, StoppingSendsTheLastStateFirst) {
  Stage stage(30);
  auto subscriber = Subscriber::connect({"/gfp/"}, stage.subscriber);
  std::uint64_t sequence = 0;
  const auto put_next = [&] {
    Scene scene = test::hand_made_scene(1);
    scene.sequence = ++sequence;
    stage.publisher->put(shared(std::move(scene)));
  };
  put_next();
  ASSERT_TRUE(wait_for(*subscriber, [&](const Message&) { return true; }).has_value());
  put_next();
  stage.publisher->stop();
  bool last_scene = false;
  const auto goodbye = wait_for(*subscriber, [&](const Message& m) {
    last_scene = last_scene || m.topic == "/gfp/scene/";
    v1::DaemonStatus status;
    return m.topic == "/gfp/status/gfpd/" && status.ParseFromString(m.payload) && status.state() == "stopping";
  });
  EXPECT_TRUE(goodbye.has_value());
  EXPECT_TRUE(last_scene);
}

TEST(Publisher, TwoDaemonsCannotServeOneEndpoint) {
  Stage stage;
  const auto second = Publisher::start(stage.options, 2);
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().what.find("another gfpd serves this endpoint"), std::string::npos);
}

TEST(Publisher, AnEndpointThatCannotBeBoundIsNamed) {
  PublishOptions options;
  options.sensor_endpoints = {"ipc:///proc/no/such/place"};
  const auto publisher = Publisher::start(options, 1);
  ASSERT_FALSE(publisher.has_value());
  EXPECT_EQ(publisher.error().code, ErrorCode::kIo);
  EXPECT_NE(publisher.error().what.find("/proc/no/such/place"), std::string::npos);
}

TEST(Subscriber, SaysNothingCameInsteadOfWaitingForEver) {
  Stage stage;
  auto subscriber = Subscriber::connect({"/gfp/scene/"}, stage.subscriber);
  EXPECT_EQ(subscriber->receive(1ms).error().code, ErrorCode::kTimeout);
  EXPECT_EQ(Subscriber::connect({"scene"}).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace gfp
