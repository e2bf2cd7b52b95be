#include <memory>
#include <zmq.hpp>

#include "soak/daemon_process.hpp"
#include "soak/service_trials.hpp"
#include "soak/stuck_viewer.hpp"

namespace gfp::test {
namespace {

using namespace std::chrono_literals;

constexpr int kStuck = 20, kViewers = 4;
constexpr double kAlone_s = 30;
constexpr double kMostMbEach = 32, kDroppedWithin_s = 30;

double p99(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// What the good subscriber got in a phase.
struct Heard {
  std::uint64_t received = 0, missed = 0;
  double depth_p99_ms = 0, scene_p99_ms = 0;  ///< From capture to here.
};

/// `meanwhile` is called about 30 times a second.
template <class Meanwhile>
Heard listen(Subscriber& subscriber, double seconds, Meanwhile&& meanwhile) {
  const SubscriberCounts before = subscriber.counts();
  std::vector<double> depth_ms, scene_ms;
  const Nanoseconds end = monotonic_now() + Nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
  while (monotonic_now() < end) {
    const auto message = subscriber.receive(100ms);
    if (!message) continue;
    const double age_ms = std::chrono::duration<double, std::milli>(monotonic_now() - message->stamps.monotonic).count();
    const bool is_scene = message->topic == "/gfp/scene/";
    (is_scene ? scene_ms : depth_ms).push_back(age_ms);
    if (!is_scene) meanwhile();
  }
  return {subscriber.counts().received - before.received, subscriber.counts().missed - before.missed, p99(depth_ms), p99(scene_ms)};
}

/// The daemon of this run of the soak, which lives from trial to trial.
DaemonProcess& daemon() {
  const auto endpoints = [](const std::string& name, int offset) {
    return "publish." + name + "_endpoints=[\"ipc://{folder}/" + name + "\",\"tcp://127.0.0.1:" + std::to_string(soak_port(offset)) + "\"]";
  };
  static DaemonProcess made({endpoints("sensor", 0), endpoints("state", 1), "publish.remote_depth=raw"}, {"--insecure"});
  return made;
}

}  // namespace

void listen_for_ever(const std::vector<std::string>& endpoints, bool plain) {
  if (!plain) {
    SubscriberOptions options;
    options.endpoints = endpoints;
    auto subscriber = Subscriber::connect({"/gfp/"}, options);
    while (subscriber) static_cast<void>(subscriber->receive(1s));
    return;
  }
  zmq::context_t context(1);
  zmq::socket_t socket(context, zmq::socket_type::sub);
  for (const std::string& endpoint : endpoints) socket.connect(endpoint);
  socket.set(zmq::sockopt::subscribe, "/gfp/");
  for (zmq::message_t part;;) static_cast<void>(socket.recv(part));
}

Trial stuck_trial(std::uint64_t number, double seconds) {
  Trial trial;
  DaemonProcess& served = daemon();
  ChildProcess& process = served.process();
  const bool plain = number % 2 == 1;
  Subscriber good = served.subscribe({"/gfp/sensor/kinect/depth/", "/gfp/scene/"});
  if (!served.is_serving()) return {"nothing is published: " + served.log(), {}};
  const Heard alone = listen(good, kAlone_s, [] {});

  const long descriptors_before = process.descriptors();
  const double before_mb = process.rss_mb();
  std::vector<std::unique_ptr<ChildProcess>> stuck;
  std::vector<std::string> command = {"/proc/self/exe", plain ? "--listen-plainly" : "--listen"};
  for (const int i : {0, 1}) command.push_back(plain ? "tcp://127.0.0.1:" + std::to_string(soak_port(i)) : served.endpoint(i == 0 ? "sensor" : "state"));
  for (int i = 0; i < kStuck; ++i) stuck.push_back(std::make_unique<ChildProcess>(command, "/dev/null"));
  if (seconds_until([&] { listen(good, 0.1, [] {}); return process.descriptors() >= descriptors_before + 2 * kStuck; }, 60) < 0) return {"the subscribers that are to be stuck did not connect", {}};
  listen(good, 3, [] {});  // they listen for a while: who hangs before the first heartbeat, a second after it came, is not found out
  std::vector<std::unique_ptr<StuckViewer>> viewers;
  for (int i = 0; i < kViewers; ++i) viewers.push_back(std::make_unique<StuckViewer>(served.view_port()));
  for (const auto& child : stuck) child->signal(SIGSTOP);
  const Nanoseconds stopped = monotonic_now();
  trial.measured("missed_as_they_stopped", listen(good, 1, [] {}).missed);  // that is what 20 busy subscribers cost on so few cores
  double most_mb = 0, dropped_s = -1;
  const Heard beside = listen(good, seconds, [&] {
    most_mb = std::max(most_mb, process.rss_mb());
    if (dropped_s < 0 && process.descriptors() <= descriptors_before) dropped_s = std::chrono::duration<double>(monotonic_now() - stopped).count();
  });

  const double mb_each = (most_mb - before_mb) / (kStuck + kViewers);
  trial.measured("received_alone", alone.received);
  trial.measured("received_beside", beside.received);
  trial.measured("missed_alone", alone.missed);
  trial.measured("missed_beside", beside.missed);
  trial.measured("depth_p99_ms_alone", alone.depth_p99_ms);
  trial.measured("depth_p99_ms_beside", beside.depth_p99_ms);
  trial.measured("scene_p99_ms_alone", alone.scene_p99_ms);
  trial.measured("scene_p99_ms_beside", beside.scene_p99_ms);
  trial.measured("mb_each", mb_each);
  trial.measured("dropped_after_s", dropped_s);
  if (beside.missed > alone.missed) trial.failure = std::to_string(beside.missed) + " messages lost beside stuck subscribers, " + std::to_string(alone.missed) + " without";
  if (mb_each > kMostMbEach) trial.failure = std::to_string(mb_each) + " MB a stuck client";
  if (dropped_s < 0 || dropped_s > kDroppedWithin_s)
    trial.failure = std::to_string(process.descriptors() - descriptors_before) + " connections of stuck clients are still there after " + std::to_string(seconds) + " s";
  return trial;
}

}  // namespace gfp::test
