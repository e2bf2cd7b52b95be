#include "view/hub.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "foxglove/scene.pb.h"
#include "foxglove/sensor.pb.h"
#include "support/hand_made_scene.hpp"

namespace gfp::view {
namespace {

using Json = nlohmann::json;

/// A client whose socket is the test: what it was sent, by kind.
struct Viewer {
  explicit Viewer(Hub& hub, std::size_t max_bytes = 16U << 20U) : client(max_bytes, [this] { ++wakes; }), hub_(hub) { hub.join(client); }
  ~Viewer() { hub_.leave(client); }

  void read() {
    while (const auto next = client.take()) {
      if (next->is_text) heard(Json::parse(next->head));
      else if (next->head[0] == '\2') times.push_back(next->head);
      else if (next->head[0] == '\3') answers.push_back(next->head);
      else if (next->head[0] == '\5') states.push_back(next->head);
      else payloads[topics.at(static_cast<std::uint8_t>(next->head[1]))].push_back(*next->payload);
    }
  }
  void subscribe(const std::string& topic) {
    read();
    topics[channels.at(topic)] = topic;  // the subscription has the channel's number
    hub_.heard(client, Json{{"op", "subscribe"}, {"subscriptions", {{{"id", channels.at(topic)}, {"channelId", channels.at(topic)}}}}}.dump());
    read();
  }

  int wakes = 0;
  Client client;
  std::map<std::string, int> channels;
  std::map<int, std::string> topics;
  std::map<std::string, std::vector<std::string>> payloads;
  std::vector<Json> statuses;
  std::vector<std::string> times, answers, states;  ///< Binary messages 2, 3 and 5.
  std::vector<Json> failures;                       ///< Of service calls.

 private:
  void heard(const Json& message) {
    if (message["op"] == "advertise")
      for (const Json& channel : message["channels"]) channels[channel["topic"]] = channel["id"];
    if (message["op"] == "status") statuses.push_back(message);
    if (message["op"] == "serviceCallFailure") failures.push_back(message);
  }
  Hub& hub_;
};

Inbox::Content of_scene(Scene scene) {
  Inbox::Content content;
  const std::string sensor = scene.sensor;
  content.scenes[sensor].value = std::make_shared<const Scene>(std::move(scene));
  return content;
}

Inbox::Content of_frame() {
  auto frame = std::make_shared<Frame>();
  frame->sensor = "front";
  frame->camera = default_kinect_camera(4, 3);
  frame->depth.pixels = Image<std::uint16_t>(4, 3, 1000);
  frame->depth.pixels.at(1, 1) = 0;
  frame->depth.scale_m = 0.0005;
  frame->T_world_sensor.translation() = Eigen::Vector3d(1, 2, 3);
  Inbox::Content content;
  content.frames["front"].value = frame;
  return content;
}

template <class T>
T parsed(const std::string& payload) {
  T message;
  EXPECT_TRUE(message.ParseFromString(payload));
  return message;
}

/// A request as a player bar sends it.
std::string playback_request(bool play, float speed, std::optional<std::uint64_t> seek_ns, const std::string& id) {
  std::string bytes(19, '\0');
  bytes[0] = '\3';
  bytes[1] = play ? '\0' : '\1';
  std::memcpy(&bytes[2], &speed, 4);
  bytes[6] = seek_ns ? '\1' : '\0';
  const std::uint64_t seek = seek_ns.value_or(0);
  std::memcpy(&bytes[7], &seek, 8);
  bytes[15] = static_cast<char>(id.size());
  return bytes + id;
}

constexpr Nanoseconds kBegin(1'000'000'000'000);
constexpr ReplayControl::Player kPlayer = 0;

std::shared_ptr<ReplayControl> control_of_ten_seconds() {
  auto control = std::make_shared<ReplayControl>();
  control->join(kBegin, kBegin + Nanoseconds(10'000'000'000), 1);
  return control;
}

TEST(Hub, AReplayIsSteeredAndThoseWhoSteerLearnOfIt) {
  const auto control = control_of_ten_seconds();
  Hub hub("gfpd", 1, control);
  Viewer one(hub), other(hub), spectator(hub);
  hub.heard_binary(other.client, playback_request(true, 1, std::nullopt, "hello"));
  hub.heard_binary(one.client, playback_request(false, 0.5F, 1'004'000'000'000U, "x"));
  EXPECT_TRUE(control->state().paused);
  EXPECT_EQ(control->state().speed, 0.5);
  EXPECT_TRUE(control->wait_until_running(kPlayer, std::chrono::milliseconds(0))) << "paused, but the frame that was sought is shown";
  EXPECT_FALSE(control->wait_until_running(kPlayer, std::chrono::milliseconds(0)));
  EXPECT_EQ(control->take_seek(kPlayer)->target, kBegin + Nanoseconds(4'000'000'000));
  for (Viewer* viewer : {&one, &other, &spectator}) viewer->read();
  ASSERT_EQ(one.states.size(), 1U);
  EXPECT_EQ(one.states[0], playback_state({PlaybackStatus::kPaused, Nanoseconds(1'004'000'000'000), 0.5, true, "x"}));
  ASSERT_EQ(other.states.size(), 2U);
  EXPECT_EQ(other.states[0], playback_state({PlaybackStatus::kPlaying, Nanoseconds(1'000'000'000'000), 1, false, "hello"}));
  EXPECT_EQ(other.states[1], playback_state({PlaybackStatus::kPaused, Nanoseconds(1'004'000'000'000), 0.5, true, ""}));
  EXPECT_TRUE(spectator.states.empty()) << "who never asked does not know the message";
  hub.heard_binary(one.client, playback_request(false, 0.5F, 1U, ""));  // before the beginning
  EXPECT_EQ(control->take_seek(kPlayer)->target, kBegin);
}

TEST(Hub, AReplayTellsItsTimeAndItsEnd) {
  const auto control = control_of_ten_seconds();
  Hub hub("gfpd", 1, control);
  Viewer viewer(hub), spectator(hub);
  hub.heard_binary(viewer.client, playback_request(true, 1, std::nullopt, ""));
  for (int i = 1; i <= 3; ++i) {
    control->played(kPlayer, kBegin + Nanoseconds(i), false);
    hub.take(of_frame());
  }
  for (Viewer* each : {&viewer, &spectator}) {
    each->read();
    EXPECT_EQ(each->times, std::vector<std::string>{time_message(Nanoseconds(1'000'000'000'003))}) << "the newest only";
  }
  EXPECT_EQ(viewer.states.size(), 1U);
  control->played(kPlayer, kBegin + Nanoseconds(3), true);
  Inbox::Content content;
  content.statuses["front"].set_sensor("front");
  hub.take(std::move(content));
  viewer.read();
  ASSERT_EQ(viewer.states.size(), 2U);
  EXPECT_EQ(viewer.states[1], playback_state({PlaybackStatus::kEnded, Nanoseconds(1'000'000'000'003), 1, false, ""}));
}

TEST(Hub, WithoutARecordingNothingIsSteered) {
  Hub hub("gfpd", 1);
  Viewer viewer(hub);
  hub.heard_binary(viewer.client, playback_request(true, 1, std::nullopt, ""));
  hub.heard_binary(viewer.client, "nonsense");
  hub.heard_binary(viewer.client, "");
  viewer.read();
  EXPECT_TRUE(viewer.states.empty());
  EXPECT_EQ(viewer.statuses.size(), 3U);
}

/// A call of service `id` with the client's number 7.
std::string service_call(std::uint32_t id, const std::string& payload) {
  std::string bytes(13, '\0');
  bytes[0] = '\2';
  bytes[1] = static_cast<char>(id);
  bytes[5] = '\7';
  bytes[9] = '\x08';
  return bytes + "protobuf" + payload;
}

TEST(Hub, ACallGoesToTheDaemonAndItsAnswerToWhoAsked) {
  std::vector<PeerRequest> asked;
  Hub hub("gfpd", 1, {}, [&](PeerRequest request) { asked.push_back(std::move(request)); });
  Viewer caller(hub), other(hub);
  v1::RetypeRequest request;
  request.set_primitive("mug");
  request.add_vertices(3);
  hub.heard_binary(caller.client, service_call(1, request.SerializeAsString()));
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked[0].request.retype().primitive(), "mug");
  Inbox::Content content;
  content.replies.push_back({asked[0].peer, {}});
  content.replies[0].reply.mutable_retyped()->set_changed(1);
  hub.take(content);
  hub.take(content);  // a second answer to one question
  for (Viewer* viewer : {&caller, &other}) viewer->read();
  EXPECT_EQ(caller.answers, (std::vector<std::string>{service_response(1, 7, content.replies[0].reply.retyped().SerializeAsString())}));
  EXPECT_TRUE(other.answers.empty());
  EXPECT_EQ(service_response(1, 7, "ab"), std::string("\3\1\0\0\0\7\0\0\0\x08\0\0\0protobufab", 23));
}

TEST(Hub, WhatIsWrongWithACallItsCallerIsTold) {
  int asked = 0;
  Hub hub("gfpd", 1, {}, [&](const PeerRequest&) { ++asked; });
  Viewer caller(hub);
  hub.heard_binary(caller.client, service_call(9, ""));
  hub.heard_binary(caller.client, service_call(1, "\xff\xff"));
  caller.read();
  EXPECT_EQ(caller.failures.size(), 2U);
  for (int i = 0; i < 20; ++i) hub.heard_binary(caller.client, service_call(1, ""));
  caller.read();
  EXPECT_EQ(asked, 16) << "more do not wait";
  EXPECT_EQ(caller.failures.size(), 6U);
  hub.heard_binary(caller.client, std::string("\2\1\0\0\0\7\0\0\0\4\0\0\0json{}", 19));
  hub.heard_binary(caller.client, std::string("\2\1\0\0\0\7\0\0\0\xff\xff\xff\xffprotobuf", 21));
  caller.read();
  EXPECT_EQ(caller.statuses.size(), 2U);
  {
    Viewer gone(hub);
  }
  Hub without("gfpd", 1);
  Viewer viewer(without);
  without.heard_binary(viewer.client, service_call(1, ""));
  viewer.read();
  EXPECT_EQ(viewer.failures.size(), 1U);
}

TEST(Hub, AnAnswerToWhoHasGoneIsDropped) {
  std::vector<PeerRequest> asked;
  Hub hub("gfpd", 1, {}, [&](PeerRequest request) { asked.push_back(std::move(request)); });
  {
    Viewer gone(hub);
    hub.heard_binary(gone.client, service_call(1, ""));
  }
  Inbox::Content content;
  content.replies.push_back({asked.at(0).peer, {}});
  hub.take(std::move(content));  // no client is touched that is no more
  EXPECT_EQ(hub.clients(), 0U);
}

TEST(Hub, AShadowHasAChannelOfItsOwn) {
  Hub hub("gfpd", 1);
  Viewer viewer(hub);
  viewer.read();
  EXPECT_FALSE(viewer.channels.contains("/gfp/shadow/superquadric/"));
  Scene scene = test::hand_made_scene(2);
  scene.profile = "superquadric";
  Inbox::Content content;
  content.shadows[scene.sensor].value = std::make_shared<const Scene>(scene);
  hub.take(std::move(content));
  viewer.subscribe("/gfp/mesh/");
  viewer.subscribe("/gfp/shadow/superquadric/");
  ASSERT_EQ(viewer.payloads["/gfp/shadow/superquadric/"].size(), 1U);
  EXPECT_EQ(parsed<v1::Scene>(viewer.payloads["/gfp/shadow/superquadric/"][0]).profile(), "superquadric");
  EXPECT_EQ(viewer.payloads["/gfp/mesh/"].size(), 1U) << "its meshes are known";
  viewer.subscribe("/gfp/scene/");
  EXPECT_TRUE(viewer.payloads["/gfp/scene/"].empty());
}

TEST(Hub, ALateViewerGetsTheLastSceneAndItsTopologies) {
  Hub hub("gfpd", 1);
  hub.take(of_scene(test::hand_made_scene(3)));
  Viewer viewer(hub);
  viewer.subscribe("/gfp/mesh/");
  viewer.subscribe("/gfp/scene/");
  ASSERT_EQ(viewer.payloads["/gfp/scene/"].size(), 1U);
  EXPECT_EQ(parsed<v1::Scene>(viewer.payloads["/gfp/scene/"][0]).objects_size(), 3);
  ASSERT_EQ(viewer.payloads["/gfp/mesh/"].size(), 1U);
  EXPECT_EQ(parsed<v1::Topology>(viewer.payloads["/gfp/mesh/"][0]).hash(), 0xB0C5'0000'0000'0001U);
}

TEST(Hub, WhoDidNotSubscribeIsNotWoken) {
  Hub hub("gfpd", 1);
  Viewer viewer(hub);
  viewer.read();
  const int wakes = viewer.wakes;
  hub.take(of_scene(test::hand_made_scene(1)));
  EXPECT_EQ(viewer.wakes, wakes);
  viewer.subscribe("/gfp/scene/");
  hub.heard(viewer.client, Json{{"op", "unsubscribe"}, {"subscriptionIds", {viewer.channels.at("/gfp/scene/")}}}.dump());
  hub.take(of_scene(test::hand_made_scene(1)));
  viewer.read();
  EXPECT_EQ(viewer.payloads["/gfp/scene/"].size(), 1U);
}

TEST(Hub, ANewSensorIsAdvertisedAndItsImagesAreRight) {
  Hub hub("gfpd", 1);
  Viewer viewer(hub);
  hub.take(of_frame());
  for (const char* stream : {"depth", "camera", "cloud", "transforms"}) viewer.subscribe(std::string("/gfp/sensor/front/") + stream + "/");
  const auto depth = parsed<foxglove::RawImage>(viewer.payloads["/gfp/sensor/front/depth/"].at(0));
  EXPECT_EQ(depth.encoding(), "16UC1");
  EXPECT_EQ(depth.step(), 8U);
  ASSERT_EQ(depth.data().size(), 24U);
  EXPECT_EQ(static_cast<std::uint8_t>(depth.data()[0]) + 256 * static_cast<std::uint8_t>(depth.data()[1]), 500);  // 1000 units of 0.5 mm
  const auto cloud = parsed<foxglove::PointCloud>(viewer.payloads["/gfp/sensor/front/cloud/"].at(0));
  EXPECT_EQ(cloud.point_stride(), 12U);
  ASSERT_EQ(cloud.data().size(), 11U * 12U);  // one hole
  float z = 0;
  std::memcpy(&z, cloud.data().data() + 8, sizeof z);
  EXPECT_FLOAT_EQ(z, 0.5F);
  const auto camera = parsed<foxglove::CameraCalibration>(viewer.payloads["/gfp/sensor/front/camera/"].at(0));
  EXPECT_EQ(camera.k(0), default_kinect_camera(4, 3).fx);
  EXPECT_EQ(camera.k_size() + camera.r_size() + camera.p_size(), 9 + 9 + 12);
  const auto transforms = parsed<foxglove::FrameTransforms>(viewer.payloads["/gfp/sensor/front/transforms/"].at(0));
  EXPECT_EQ(transforms.transforms(0).child_frame_id(), "front_optical");
  EXPECT_EQ(transforms.transforms(0).translation().z(), 3);
}

TEST(Hub, MarkersAreMeshesLabelsAndGrippersThatVanishByThemselves) {
  Hub hub("gfpd", 1);
  Viewer viewer(hub);
  viewer.subscribe("/gfp/markers/");
  const Scene scene = test::hand_made_scene(2);
  hub.take(of_scene(scene));
  viewer.read();
  const auto update = parsed<foxglove::SceneUpdate>(viewer.payloads["/gfp/markers/"].at(0));
  ASSERT_EQ(update.entities_size(), 2);
  EXPECT_EQ(update.deletions_size(), 2);
  EXPECT_EQ(update.deletions(0).id(), "front/77");
  const foxglove::SceneEntity& entity = update.entities(0);
  EXPECT_EQ(entity.id(), "front/1");
  EXPECT_EQ(entity.lifetime().seconds(), 3);
  EXPECT_EQ(static_cast<std::size_t>(entity.triangles(0).indices_size()), 3 * scene.objects[0].model.topology->triangles.size());
  EXPECT_EQ(entity.triangles(0).points_size(), entity.triangles(0).colors_size());
  EXPECT_EQ(entity.cubes_size(), 4);
  EXPECT_EQ(update.entities(1).cubes_size(), 0);  // too wide for a grasp
}

// A viewer that does not read keeps a bounded amount waiting, learns of it, and costs the other nothing.
TEST(Hub, AStuckViewerIsBoundedAndTold) {
  Hub hub("gfpd", 1);
  Viewer stuck(hub, 10'000), good(hub);
  for (Viewer* viewer : {&stuck, &good}) viewer->subscribe("/gfp/scene/");
  hub.take(of_frame());
  for (Viewer* viewer : {&stuck, &good}) viewer->subscribe("/gfp/sensor/front/cloud/");
  constexpr int kScenes = 50;
  for (int i = 0; i < kScenes; ++i) {
    hub.take(of_scene(test::hand_made_scene(8)));
    good.read();
  }
  EXPECT_EQ(good.payloads["/gfp/scene/"].size(), static_cast<std::size_t>(kScenes));
  EXPECT_TRUE(good.statuses.empty());
  stuck.read();
  EXPECT_LE(stuck.payloads["/gfp/scene/"].size(), 1U);
  for (const Json& status : stuck.statuses) EXPECT_EQ(status["message"], "Send buffer limit reached");
  EXPECT_LT(stuck.statuses.size(), static_cast<std::size_t>(kScenes));  // now and then, not with each
}

TEST(Hub, WhatIsWrongWithARequestItsSenderIsTold) {
  Hub hub("gfpd", 1);
  Viewer viewer(hub);
  const auto complaint = [&](const std::string& text) {
    viewer.statuses.clear();
    hub.heard(viewer.client, text);
    viewer.read();
    return viewer.statuses.empty() ? std::string() : viewer.statuses[0]["message"].get<std::string>();
  };
  EXPECT_NE(complaint("nonsense"), "");
  EXPECT_NE(complaint("{\"\xff\xfe"), "");
  EXPECT_NE(complaint(R"({"op":"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\u00fc"})"), "");  // cut within a character
  EXPECT_EQ(complaint(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]})"), "no channel 999");
  EXPECT_EQ(complaint(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1}]})"), "");
  EXPECT_EQ(complaint(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})"), "subscription 1 exists already");
  EXPECT_EQ(complaint(R"({"op":"subscribe","subscriptions":[{"id":2,"channelId":1}]})"), "channel 1 is subscribed to already");
  EXPECT_EQ(complaint(R"({"op":"getParameters"})"), "getParameters: not offered by this server");
}

}  // namespace
}  // namespace gfp::view
