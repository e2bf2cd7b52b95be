#include "daemon/daemon.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

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
            }};
  }
  SubscriberOptions subscriber() const { return {{options.publish.sensor_endpoints[0], options.publish.state_endpoints[0]}}; }
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

}  // namespace
}  // namespace gfp
