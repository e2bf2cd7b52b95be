#include <gtest/gtest.h>

#include <map>
#include <zmq.hpp>

#include "gfp/client/scene_subscriber.hpp"
#include "gfp/v1/control.pb.h"
#include "gfp/v1/scene.pb.h"
#include "gfp/v1/status.pb.h"
#include "publish/stage.hpp"
#include "wire/schema.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::kLong;
using test::numbered_scene;
using test::Stage;

/// Topics of a snapshot once it holds a scene; the first requests may come before it was taken.
StateSnapshot snapshot_with_scene(ControlClient& client, const std::string& prefix = "") {
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (std::chrono::steady_clock::now() < deadline) {
    auto snapshot = client.snapshot(prefix);
    EXPECT_TRUE(snapshot.has_value()) << snapshot.error().what;
    if (snapshot && !snapshot->topics.empty() && snapshot->topics[0].topic != "/gfp/status/gfpd/") return *snapshot;
  }
  ADD_FAILURE() << "no scene in the snapshot";
  return {};
}

std::map<std::string, std::string> schemas_of(const StateSnapshot& snapshot) {
  std::map<std::string, std::string> schemas;
  for (const TopicState& state : snapshot.topics) schemas[state.topic] = state.schema;
  return schemas;
}

TEST(Control, ASnapshotHoldsEveryStateTopicOfItsPrefix) {
  Stage stage(30);
  stage.publisher->put(numbered_scene(1));
  v1::SensorStatus status;
  status.set_sensor("front");
  stage.publisher->put(status);
  auto client = stage.control();
  const StateSnapshot all = snapshot_with_scene(client);
  EXPECT_EQ(all.session, 1U);
  EXPECT_EQ(schemas_of(all), (std::map<std::string, std::string>{{"/gfp/mesh/b0c5000000000001/", "gfp.v1.Topology"},
                                                                {"/gfp/objects/1/", "gfp.v1.ObjectUpdate"},
                                                                {"/gfp/objects/2/", "gfp.v1.ObjectUpdate"},
                                                                {"/gfp/scene/", "gfp.v1.Scene"},
                                                                {"/gfp/status/front/", "gfp.v1.SensorStatus"},
                                                                {"/gfp/status/gfpd/", "gfp.v1.DaemonStatus"}}));
  EXPECT_EQ(schemas_of(*client.snapshot("/gfp/objects/2/")).size(), 1U);
  EXPECT_TRUE(client.snapshot("/gfp/sensor/")->topics.empty());
}

// The Clone pattern: whoever subscribes, asks, and applies what is at least `next_seq` ends with the publisher's state, whenever it
// comes. Here the publisher never repeats itself, so that nothing else can make up for a hole.
TEST(Control, LateJoinersConverge) {
  Stage stage(60);
  std::uint64_t sequence = 0;
  for (int join = 0; join < 40; ++join) {
    stage.publisher->put(numbered_scene(++sequence));
    auto subscriber = Subscriber::connect({"/gfp/scene/"}, stage.subscriber);
    ASSERT_TRUE(subscriber.has_value());
    stage.publisher->put(numbered_scene(++sequence));
    auto client = stage.control();
    const StateSnapshot snapshot = snapshot_with_scene(client, "/gfp/scene/");
    ASSERT_EQ(snapshot.topics.size(), 1U);
    stage.publisher->put(numbered_scene(++sequence));
    v1::Scene mine;
    ASSERT_TRUE(mine.ParseFromString(snapshot.topics[0].payload));
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    while (mine.header().sequence() != sequence && std::chrono::steady_clock::now() < deadline) {
      const auto message = subscriber->receive(20ms);
      if (message && message->seq >= snapshot.topics[0].next_seq) {
        v1::Scene next;
        ASSERT_TRUE(next.ParseFromString(message->payload));
        EXPECT_GE(next.header().sequence(), mine.header().sequence()) << "a message after the snapshot is older than it";
        mine = next;
      }
      // A subscription that the publisher has not heard of yet misses messages; the snapshot after it does not.
      if (!message) {
        ASSERT_TRUE(mine.ParseFromString(snapshot_with_scene(client, "/gfp/scene/").topics[0].payload));
      }
    }
    EXPECT_EQ(mine.header().sequence(), sequence) << "join " << join;
  }
}

TEST(Control, TheDescriptorsAreThoseOfTheBuild) {
  Stage stage;
  zmq::context_t context(1);
  zmq::socket_t request(context, zmq::socket_type::req);  // as Python's simplest client: REQ, with its empty delimiter
  request.set(zmq::sockopt::linger, 0);
  request.set(zmq::sockopt::rcvtimeo, 20'000);
  request.connect(stage.options.control_endpoints[0]);
  request.send(zmq::str_buffer("desc"), zmq::send_flags::none);
  zmq::message_t reply;
  ASSERT_TRUE(request.recv(reply).has_value());
  EXPECT_EQ(reply.to_string(), wire::all_descriptors());
}

// Nonsense gets an answer that says so, and the next request is served.
TEST(Control, NonsenseIsRefused) {
  Stage stage;
  zmq::context_t context(1);
  zmq::socket_t dealer(context, zmq::socket_type::dealer);
  dealer.set(zmq::sockopt::linger, 0);
  dealer.set(zmq::sockopt::rcvtimeo, 20'000);
  dealer.connect(stage.options.control_endpoints[0]);
  const auto ask = [&](const std::string& body) {
    dealer.send(zmq::buffer(body), zmq::send_flags::none);
    zmq::message_t part;
    v1::ControlReply reply;
    EXPECT_TRUE(dealer.recv(part).has_value());
    EXPECT_TRUE(reply.ParseFromArray(part.data(), static_cast<int>(part.size())));
    return reply;
  };
  EXPECT_EQ(ask("\xff\xff\xff").code(), v1::ControlReply::CODE_INVALID);
  EXPECT_EQ(ask("").code(), v1::ControlReply::CODE_INVALID);
  v1::ControlRequest fit;
  fit.set_id(7);
  fit.mutable_fit();
  const auto no_daemon = ask(fit.SerializeAsString());
  EXPECT_EQ(no_daemon.code(), v1::ControlReply::CODE_UNAVAILABLE);
  EXPECT_EQ(no_daemon.id(), 7U);
  auto client = stage.control();
  EXPECT_TRUE(client.snapshot().has_value());
}

// Who announces more than a request can have is cut off; others are served.
TEST(Control, AHugeRequestCostsItsSenderTheConnection) {
  Stage stage;
  zmq::context_t context(1);
  zmq::socket_t dealer(context, zmq::socket_type::dealer);
  dealer.set(zmq::sockopt::linger, 0);
  dealer.set(zmq::sockopt::rcvtimeo, 300);
  dealer.connect(stage.options.control_endpoints[0]);
  dealer.send(zmq::message_t(8U << 20U), zmq::send_flags::none);
  zmq::message_t reply;
  EXPECT_FALSE(dealer.recv(reply).has_value());
  auto client = stage.control();
  EXPECT_TRUE(client.snapshot().has_value());
}

TEST(Control, ADaemonThatIsNotThereIsATimeout) {
  auto client = ControlClient::connect({"ipc:///tmp/gfp-no-such-daemon", 10ms, {}});
  ASSERT_TRUE(client.has_value());
  EXPECT_EQ(client->snapshot().error().code, ErrorCode::kTimeout);
}

}  // namespace
}  // namespace gfp
