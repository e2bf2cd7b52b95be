#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <zmq.hpp>

#include "gfp/client/subscriber.hpp"
#include "publish/stage.hpp"

namespace gfp {
namespace {

using namespace std::chrono_literals;
using test::kLong;
using test::Stage;

FramePtr frame(std::uint64_t sequence) {
  auto made = std::make_shared<Frame>();
  made->sensor = "front";
  made->sequence = sequence;
  made->depth.pixels = Image<std::uint16_t>(640, 480, static_cast<std::uint16_t>(sequence));
  return made;
}

double resident_mb() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

// Twenty subscribers that never read, one that does: it gets every depth image, and the stuck ones cost a bounded amount each, both
// ends' buffers together (they live in this process).
TEST(SlowSubscribers, TwentyThatAreStuckCostTheOtherNothing) {
  constexpr int kStuck = 20, kFrames = 200;
  Stage stage;
  SubscriberOptions stuck_options = stage.subscriber;
  stuck_options.high_water_mark = 2;
  std::vector<Subscriber> stuck;
  for (int i = 0; i < kStuck; ++i) stuck.push_back(std::move(*Subscriber::connect({"/gfp/sensor/front/depth/"}, stuck_options)));
  auto good = Subscriber::connect({"/gfp/sensor/front/depth/"}, stage.subscriber);
  std::uint64_t sequence = 0;
  const auto next_depth = [&]() -> bool {
    stage.publisher->put(frame(++sequence));
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    while (std::chrono::steady_clock::now() < deadline) {
      const auto message = good->receive(1000ms);
      if (message) return true;
      if (good->counts().received == 0) stage.publisher->put(frame(++sequence));  // until the subscription is known
    }
    return false;
  };
  ASSERT_TRUE(next_depth());
  const double before_mb = resident_mb();
  const std::uint64_t missed_before = good->counts().missed;
  for (int i = 0; i < kFrames; ++i) ASSERT_TRUE(next_depth()) << "frame " << i;
  EXPECT_EQ(good->counts().missed, missed_before);
  EXPECT_LE(resident_mb() - before_mb, 32.0 * kStuck);
}

// Subscriptions without end, from one client: bounded, and the other subscriber goes on.
TEST(SlowSubscribers, AFloodOfSubscriptionsCostsTheOtherNothing) {
  Stage stage;
  zmq::context_t context(1);
  zmq::socket_t flood(context, zmq::socket_type::sub);
  flood.set(zmq::sockopt::linger, 0);
  flood.connect(stage.options.state_endpoints[0]);
  for (int i = 0; i < 20'000; ++i) flood.set(zmq::sockopt::subscribe, "/gfp/none/" + std::to_string(i) + "/");
  auto good = Subscriber::connect({"/gfp/status/gfpd/"}, stage.subscriber);
  EXPECT_TRUE(good->receive(kLong).has_value());
}

// What ZeroMQ lets a stranger send to a publisher: nothing of it harms.
TEST(SlowSubscribers, HostileBytesAreDropped) {
  Stage stage;
  for (const std::size_t size : {0, 1, 5000, 4 << 20}) {
    zmq::context_t context(1);
    zmq::socket_t stranger(context, zmq::socket_type::xsub);
    stranger.set(zmq::sockopt::linger, 0);
    stranger.connect(stage.options.state_endpoints[0]);
    stranger.send(zmq::message_t(std::string(size, '\7')), zmq::send_flags::none);
    auto good = Subscriber::connect({"/gfp/status/gfpd/"}, stage.subscriber);
    EXPECT_TRUE(good->receive(kLong).has_value()) << "after " << size << " bytes";
  }
}

}  // namespace
}  // namespace gfp
