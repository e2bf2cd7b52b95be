#include <gtest/gtest.h>

#include <zmq.hpp>

#include "gfp/client/subscriber.hpp"
#include "gfp/v1/scene.pb.h"
#include "publish/stage.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::kLong;
using test::Stage;

/// Waits for a refusal whose reason has these words.
bool is_refused(Publisher& publisher, const std::string& words) {
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (std::chrono::steady_clock::now() < deadline) {
    for (const Refusal& refusal : publisher.take_refusals())
      if (refusal.peer == "this host" && refusal.count > 0 && refusal.why.find(words) != std::string::npos) return true;
    std::this_thread::yield();
  }
  return false;
}

Subscriber status_subscriber(const Stage& stage) { return std::move(*Subscriber::connect({"/gfp/status/gfpd/"}, stage.subscriber)); }

// Each subscriber has two connections, to the sensors' socket and to that of the state.
TEST(ConnectionGuard, WhoComesBeyondTheCapIsSentAwayUntilThereIsRoom) {
  Stage stage;
  stage.options.max_connections = 8;
  stage.start(2);
  std::vector<Subscriber> served;
  for (int i = 0; i < 4; ++i) {
    served.push_back(status_subscriber(stage));
    ASSERT_TRUE(served.back().receive(kLong).has_value());
  }
  Subscriber one_more = status_subscriber(stage);
  EXPECT_TRUE(is_refused(*stage.publisher, "publish.max_connections = 8"));
  EXPECT_FALSE(one_more.receive(300ms).has_value());
  served.pop_back();
  EXPECT_TRUE(one_more.receive(kLong).has_value());
}

TEST(ConnectionGuard, WhoSubscribesWithoutEndIsCutOff) {
  Stage stage;
  zmq::context_t context(1);
  zmq::socket_t many(context, zmq::socket_type::sub);
  many.set(zmq::sockopt::linger, 0);
  many.set(zmq::sockopt::sndhwm, 0);  // else ZeroMQ itself keeps to a thousand
  many.connect(stage.options.state_endpoints[0]);
  for (std::size_t i = 0; i < ConnectionGuard::kMaxSubscriptions; ++i) many.set(zmq::sockopt::subscribe, "/gfp/none/" + std::to_string(i) + "/");
  many.set(zmq::sockopt::subscribe, "/gfp/status/gfpd/");
  EXPECT_TRUE(is_refused(*stage.publisher, "more than 1000 subscriptions"));
  EXPECT_TRUE(status_subscriber(stage).receive(kLong).has_value());
}

// Its snapshot may be from before the object went, and its subscription from after it.
TEST(Publisher, ALateJoinerHearsWhichObjectsWentLately) {
  Stage stage(60);
  stage.publisher->put(test::numbered_scene(1, 2));
  Scene scene = *test::numbered_scene(2, 1);
  scene.lost = {2};
  stage.publisher->put(test::shared(std::move(scene)));
  auto client = stage.control();
  while (client.snapshot("/gfp/scene/")->topics.empty()) {  // until the publisher has taken them in
  }
  auto subscriber = Subscriber::connect({"/gfp/objects/"}, stage.subscriber);
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  bool is_told = false;
  while (!is_told && std::chrono::steady_clock::now() < deadline) {
    const auto message = subscriber->receive(100ms);
    v1::ObjectUpdate update;
    is_told = message && update.ParseFromString(message->payload) && update.object().id() == 2 && update.object().status() == v1::SceneObject::STATUS_LOST;
  }
  EXPECT_TRUE(is_told);
}

}  // namespace
}  // namespace gfp
