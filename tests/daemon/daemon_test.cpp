#include "daemon/daemon.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>

#include "gfp/client/control_client.hpp"
#include "gfp/client/scene_subscriber.hpp"
#include "support/hand_made_scene.hpp"
#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;

/// Frames without an end, a millisecond apart; counts how often it was opened. A name that starts with `bad` cannot be made.
class EndlessSource final : public FrameSource {
 public:
  EndlessSource(std::string name, std::atomic<int>& opens) : name_(std::move(name)), opens_(opens) {}
  SourceInfo info() const override { return {"endless", "fake", "42", 0, 0, 0, false}; }
  Result<void> open() override { return ++opens_, Result<void>{}; }
  Result<Frame> grab(std::chrono::milliseconds) override {
    std::this_thread::sleep_for(1ms);  // the rhythm of the fake device; nothing is waited for
    Frame frame;
    frame.sensor = name_;
    frame.sequence = sequence_++;
    frame.stamps.monotonic = monotonic_now();
    return frame;
  }
  void close() noexcept override {}

 private:
  std::string name_;
  std::atomic<int>& opens_;
  std::uint64_t sequence_ = 0;
};

struct Bench {
  test::TemporaryFolder folder;
  DaemonOptions options;
  std::atomic<int> opens{0}, processed{0};
  std::atomic<bool> throws{false};
  std::atomic<double> seen_min_height_m{0};

  Bench() {
    options.publish.sensor_endpoints = {"ipc://" + (folder / "sensor").string()};
    options.publish.state_endpoints = {"ipc://" + (folder / "state").string()};
    options.publish.control_endpoints = {"ipc://" + (folder / "control").string()};
    options.publish.heartbeat_s = 0.05;
    options.sensors = {SensorConfig{}};
    options.sensors[0].name = "front";
  }
  DaemonParts parts() {
    return {[this](const SensorConfig& sensor) -> Result<std::unique_ptr<FrameSource>> {
              if (sensor.name.starts_with("bad")) return failure(ErrorCode::kUnsupported, "no such driver");
              return std::make_unique<EndlessSource>(sensor.name, opens);
            },
            [this](const Frame& frame, const SceneMemory& memory, const PipelineOptions& pipeline) {
              ++processed;
              seen_min_height_m = pipeline.segmentation.min_height_m;
              if (throws) throw std::runtime_error("a bug in a stage");
              PipelineResult result{test::hand_made_scene(2), memory};
              result.scene.sensor = frame.sensor;
              result.scene.sequence = frame.sequence;
              result.scene.stamps = frame.stamps;
              ++result.memory.frames;
              return result;
            },
            [this](const Scene& scene, const SceneMemory&, const PipelineOptions& pipeline, ShadowMemory& kept) {
              if (throws) throw std::runtime_error("a bug in a shadow");
              kept.method = pipeline.shadow;
              Scene shadow = scene;
              shadow.profile = pipeline.shadow;
              return shadow;
            },
            [](const std::string& primitive, const std::vector<std::uint32_t>& vertices, std::optional<PointType> type) -> Result<RetypedPrimitive> {
              if (primitive != "mug") return failure(ErrorCode::kNotFound, "no " + primitive);
              return RetypedPrimitive{primitive, "mug.gfp", static_cast<int>(vertices.size()), {PointType::kRegular, type.value_or(PointType::kControl)}, {std::nullopt, type}};
            }};
  }
  ControlOptions control() const { return {options.publish.control_endpoints[0], 20s, {}}; }
  SubscriberOptions subscriber() const {
    SubscriberOptions made;
    made.endpoints = {options.publish.sensor_endpoints[0], options.publish.state_endpoints[0]};
    return made;
  }
};

template <class Condition>
bool eventually(Condition&& condition) {
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (!condition())
    if (std::chrono::steady_clock::now() > deadline) return false;
    else std::this_thread::yield();
  return true;
}

TEST(Daemon, FramesBecomeScenesForASubscriber) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 5);
  ASSERT_TRUE(daemon.has_value()) << daemon.error().what;
  auto scenes = SceneSubscriber::connect(bench.subscriber());
  Result<Scene> scene = failure(ErrorCode::kTimeout, "");
  ASSERT_TRUE(eventually([&] { return (scene = scenes->next(100ms)) && has_all_meshes(*scene); }));
  EXPECT_EQ(scene->sensor, "front");
  EXPECT_EQ(scene->objects.size(), 2U);
}

// It comes and goes with the configuration, under a topic of its own.
TEST(Daemon, AShadowIsPublishedUnderItsMethod) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 7);
  ASSERT_TRUE(daemon);
  auto subscriber = Subscriber::connect({"/gfp/shadow/superquadric/"}, bench.subscriber());
  ASSERT_TRUE(subscriber);
  EXPECT_TRUE(eventually([&] { return bench.processed > 20; }));
  EXPECT_FALSE(subscriber->receive(0ms));  // none is configured
  bench.options.pipeline.shadow = "superquadric";
  ASSERT_TRUE((*daemon)->reload(bench.options));
  const auto message = subscriber->receive(20s);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->topic, "/gfp/shadow/superquadric/");
  v1::Scene shadow;
  ASSERT_TRUE(shadow.ParseFromArray(message->payload.data(), static_cast<int>(message->payload.size())));
  EXPECT_EQ(shadow.profile(), "superquadric");
  EXPECT_EQ(shadow.objects_size(), 2);
}

TEST(Daemon, ControlPointsAreSaidByHand) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 5);
  ASSERT_TRUE(daemon);
  std::promise<PeerReply> answered;
  const auto ask = [&](const std::string& primitive, v1::RetypeRequest::Type type) {
    answered = {};
    PeerRequest request;
    request.peer.identity = "page";
    request.request.mutable_retype()->set_primitive(primitive);
    request.request.mutable_retype()->add_vertices(1);
    request.request.mutable_retype()->set_type(type);
    (*daemon)->ask(std::move(request), [&](PeerReply reply) { answered.set_value(std::move(reply)); });
    return answered.get_future().get();
  };
  const PeerReply done = ask("mug", v1::RetypeRequest::TYPE_CONTROL);
  EXPECT_EQ(done.peer.identity, "page");
  ASSERT_EQ(done.reply.code(), v1::ControlReply::CODE_OK) << done.reply.error();
  EXPECT_EQ(done.reply.retyped().changed(), 1U);
  EXPECT_EQ(done.reply.retyped().types(), std::string("\0\1", 2));
  EXPECT_EQ(done.reply.retyped().manual_types(), std::string("\0\2", 2));
  EXPECT_EQ(ask("shoe", v1::RetypeRequest::TYPE_CONTROL).reply.code(), v1::ControlReply::CODE_NOT_FOUND);
  EXPECT_EQ(ask("mug", static_cast<v1::RetypeRequest::Type>(9)).reply.code(), v1::ControlReply::CODE_INVALID);
}

TEST(Daemon, WithoutASensorOrWithABadOneItDoesNotStart) {
  Bench bench;
  bench.options.sensors[0].name = "bad";
  EXPECT_EQ(Daemon::start(bench.options, bench.parts(), 1).error().code, ErrorCode::kUnsupported);
  bench.options.sensors.clear();
  EXPECT_EQ(Daemon::start(bench.options, bench.parts(), 1).error().what, "sensors: none is configured, expected at least one");
}

TEST(Daemon, AnExceptionCostsItsFrame) {
  Bench bench;
  bench.throws = true;
  auto daemon = Daemon::start(bench.options, bench.parts(), 1);
  ASSERT_TRUE(eventually([&] { return bench.processed > 3; }));
  bench.throws = false;
  auto scenes = SceneSubscriber::connect(bench.subscriber());
  EXPECT_TRUE(eventually([&] { return scenes->next(100ms).has_value(); }));
}

TEST(Daemon, ReloadKeepsSensorsThatDidNotChangeAndTakesNewOptions) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 1);
  ASSERT_TRUE(eventually([&] { return bench.opens == 1; }));
  DaemonOptions changed = bench.options;
  changed.pipeline.segmentation.min_height_m = 0.125;
  ASSERT_TRUE((*daemon)->reload(changed).has_value());
  ASSERT_TRUE(eventually([&] { return bench.seen_min_height_m == 0.125; }));
  EXPECT_EQ(bench.opens, 1);
  changed.sensors.push_back(changed.sensors[0]);
  changed.sensors[1].name = "back";
  ASSERT_TRUE((*daemon)->reload(changed).has_value());
  ASSERT_TRUE(eventually([&] { return bench.opens == 2; }));
  changed.sensors[0].source.grab_timeout_s = 0.25;  // another configuration: started anew
  ASSERT_TRUE((*daemon)->reload(changed).has_value());
  EXPECT_TRUE(eventually([&] { return bench.opens == 3; }));
}

TEST(Daemon, AFailedReloadChangesNothing) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 1);
  DaemonOptions changed = bench.options;
  changed.pipeline.segmentation.min_height_m = 0.125;
  changed.sensors.push_back(changed.sensors[0]);
  changed.sensors[1].name = "bad";
  EXPECT_FALSE((*daemon)->reload(changed).has_value());
  const int before = bench.processed;
  ASSERT_TRUE(eventually([&] { return bench.processed > before + 3; }));
  EXPECT_NE(bench.seen_min_height_m, 0.125);
}

TEST(Daemon, StatusesNameRatesAndStates) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 1);
  auto messages = Subscriber::connect({"/gfp/status/front/"}, bench.subscriber());
  ASSERT_TRUE(eventually([&] {
    (*daemon)->tick();
    const auto message = messages->receive(50ms);
    v1::SensorStatus status;
    return message && status.ParseFromString(message->payload) && status.state() == "streaming" && status.scenes_fps() > 0 && status.serial() == "42";
  }));
}

TEST(Daemon, StoppingTwiceIsStoppingOnce) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 1);
  (*daemon)->stop();
  (*daemon)->stop();
}

TEST(DaemonControl, ParametersHoldFromTheNextFrameOn) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 5);
  auto client = ControlClient::connect(bench.control());
  const auto before = client->parameters({"pipeline.segmentation."});
  ASSERT_TRUE(before.has_value()) << before.error().what;
  EXPECT_EQ(before->at("pipeline.segmentation.min_height_m"), "0.007");
  const auto after = client->set_parameters({{"pipeline.segmentation.min_height_m", "0.02"}});
  ASSERT_TRUE(after.has_value()) << after.error().what;
  EXPECT_EQ(*after, (std::map<std::string, std::string>{{"pipeline.segmentation.min_height_m", "0.02"}}));
  EXPECT_TRUE(eventually([&] { return bench.seen_min_height_m == 0.02; }));
}

// All or nothing, with the error that the configuration file would have got; sensors and endpoints are not for clients to change.
TEST(DaemonControl, BadParametersChangeNothing) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 5);
  auto client = ControlClient::connect(bench.control());
  const auto refused = [&](const std::string& path, const std::string& value) {
    const auto reply = client->set_parameters({{"pipeline.segmentation.min_points", "123"}, {path, value}});
    return reply ? std::string() : reply.error().what;
  };
  EXPECT_NE(refused("pipeline.segmentation.min_height_m", "-1").find("min_height_m"), std::string::npos);
  EXPECT_NE(refused("pipeline.segmentation.min_heigth_m", "0.1").find("did you mean"), std::string::npos);
  EXPECT_NE(refused("sensors.0.name", "back").find("only what is below pipeline."), std::string::npos);
  EXPECT_EQ(client->parameters({"pipeline.segmentation.min_points"})->begin()->second, "300");
}

TEST(DaemonControl, FitsAnewWhatStandsInARegion) {
  Bench bench;
  auto daemon = Daemon::start(bench.options, bench.parts(), 5);
  auto client = ControlClient::connect(bench.control());
  ASSERT_TRUE(eventually([&] { return bench.processed > 0; }));
  const auto all = client->fit();
  ASSERT_TRUE(all.has_value()) << all.error().what;
  EXPECT_EQ(all->objects.size(), 2U);  // their boxes have the centre (35, 55)
  EXPECT_TRUE(has_all_meshes(*all));
  EXPECT_EQ(client->fit("front", {{30, 50, 36, 56}})->objects.size(), 2U);
  EXPECT_EQ(client->fit("front", {{36, 50, 600, 400}})->objects.size(), 0U);
  const auto nowhere = client->fit("back");
  ASSERT_FALSE(nowhere.has_value());
  EXPECT_EQ(nowhere.error().code, ErrorCode::kNotFound);
  EXPECT_NE(nowhere.error().what.find("back"), std::string::npos);
}

// In the base's frame, the best that is sure enough and within reach; where there is none, the reason.
TEST(DaemonControl, TheBestGraspIsOneThatTheRobotReaches) {
  Bench bench;
  Scene scene = test::hand_made_scene(2);
  std::vector<Grasp>& grasps = scene.objects[0].grasps.grasps;
  for (Grasp& grasp : grasps) grasp.abstain = false;
  bench.options.robot.T_world_base = scene.T_world_sensor * grasps[1].T_camera_tcp * Eigen::Translation3d(0, 0, -0.5);  // 0.5 m from the second
  const Transform T_base_camera = bench.options.robot.T_world_base.inverse() * scene.T_world_sensor;
  grasps[1].T_camera_pregrasp_tcp = grasps[1].T_camera_tcp;
  const double first_m = (T_base_camera * grasps[0].T_camera_tcp).translation().norm();
  bench.options.robot.min_reach_m = 0.49;
  bench.options.robot.max_reach_m = 0.51;
  ASSERT_TRUE(first_m < 0.49 || first_m > 0.51) << "the first grasp is within reach too: " << first_m;
  DaemonParts parts = bench.parts();
  parts.process = [&](const Frame& frame, const SceneMemory& memory, const PipelineOptions&) {
    PipelineResult result{scene, memory};
    result.scene.sensor = frame.sensor;
    return result;
  };
  auto daemon = Daemon::start(bench.options, parts, 5);
  auto client = ControlClient::connect(bench.control());
  Result<ReachableGrasp> found = failure(ErrorCode::kTimeout, "");
  ASSERT_TRUE(eventually([&] { return (found = client->best_grasp(1)).has_value(); })) << found.error().what;
  EXPECT_EQ(found->grasp.width_m, grasps[1].width_m);
  EXPECT_TRUE(found->T_base_tcp.isApprox(T_base_camera * grasps[1].T_camera_tcp, 1e-9));
  EXPECT_NEAR(found->T_base_tcp.translation().norm(), 0.5, 1e-9);
  EXPECT_NE(client->best_grasp(2).error().what.find("too_wide"), std::string::npos);
  EXPECT_NE(client->best_grasp(999).error().what.find("999"), std::string::npos);
}

}  // namespace
}  // namespace gfp
