#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <deque>
#include <optional>
#include <zmq.hpp>

#include "gfp/v1/status.pb.h"
#include "soak/daemon_process.hpp"
#include "soak/service_trials.hpp"

namespace gfp::test {
namespace {

using namespace std::chrono_literals;

constexpr double kFlood_s = 60, kConnectsPerSecond = 1000, kLeastRate_hz = 29, kMostExtraMb = 5;
constexpr int kSubscriptions = 20'000;
constexpr std::size_t kMostOpen = 600;  ///< That the flood holds open, half of them silent, half with a greeting that never goes on.

int connect_to(const std::string& path, int port) {
  const int file = socket(path.empty() ? AF_INET : AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (path.empty()) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    static_cast<void>(connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  } else {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    static_cast<void>(connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  }
  return file;
}

/// Connects to all that is open, a thousand times a second.
class Flood {
 public:
  Flood(std::vector<std::string> paths, std::vector<int> ports) : paths_(std::move(paths)), ports_(std::move(ports)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
  std::uint64_t connects() const { return connects_; }

 private:
  void run(const std::stop_token& stop) {
    const Nanoseconds begin = monotonic_now();
    while (!stop.stop_requested()) {
      const auto due = static_cast<std::uint64_t>(std::chrono::duration<double>(monotonic_now() - begin).count() * kConnectsPerSecond);
      for (; connects_ < due; ++connects_) one(connects_);
      std::this_thread::sleep_for(2ms);
    }
    for (const int file : open_) close(file);
  }
  void one(std::uint64_t i) {
    const std::size_t targets = paths_.size() + ports_.size(), target = i % targets;
    const int file = target < paths_.size() ? connect_to(paths_[target], 0) : connect_to("", ports_[target - paths_.size()]);
    const char greeting[] = "\xff\0\0\0\0\0\0\0\x01\x7f\x03";
    if (i / targets % 3 == 1) static_cast<void>(send(file, greeting, sizeof greeting - 1, MSG_NOSIGNAL));
    if (i / targets % 3 == 2) static_cast<void>(send(file, "GET nothing of this kind\r\n\r\n", 28, MSG_NOSIGNAL));
    open_.push_back(file);
    if (open_.size() <= kMostOpen) return;
    close(open_.front());
    open_.pop_front();
  }

  const std::vector<std::string> paths_;
  const std::vector<int> ports_;
  std::atomic<std::uint64_t> connects_ = 0;
  std::deque<int> open_;
  std::jthread thread_;
};

/// One client with many subscriptions.
struct ManySubscriptions {
  zmq::context_t context{1};
  zmq::socket_t socket{context, zmq::socket_type::sub};
  explicit ManySubscriptions(const std::string& endpoint) {
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::sndhwm, 0);
    for (int i = 0; i < kSubscriptions; ++i) socket.set(zmq::sockopt::subscribe, "/gfp/none/" + std::to_string(i) + "/");
    socket.connect(endpoint);
  }
};

}  // namespace

Trial flood_trial(std::uint64_t) {
  Trial trial;
  const std::string tcp = "\"tcp://127.0.0.1:" + std::to_string(soak_port(2)) + "\"";
  DaemonProcess served({"publish.state_endpoints=[\"ipc://{folder}/state\"," + tcp + "]"}, {"--insecure"});
  ChildProcess& process = served.process();
  if (!served.is_serving()) return {"nothing is published: " + served.log(), {}};
  Subscriber good = served.subscribe({"/gfp/sensor/kinect/depth/", "/gfp/status/"});
  std::uint64_t frames = 0, depth_images = 0;
  double most_mb = 0;
  long most_descriptors = 0;
  const auto listen_for = [&](double seconds) {
    const Nanoseconds end = monotonic_now() + Nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
    while (monotonic_now() < end) {
      const auto message = good.receive(100ms);
      v1::SensorStatus status;
      if (message && message->topic == "/gfp/status/kinect/" && status.ParseFromString(message->payload)) {
        frames = status.frames();
        most_descriptors = std::max(most_descriptors, process.descriptors());
        most_mb = std::max(most_mb, process.rss_mb());
      }
      if (message && message->topic == "/gfp/sensor/kinect/depth/") ++depth_images;
    }
  };
  listen_for(20);
  const double before_mb = process.rss_mb();
  const long descriptors_before = process.descriptors();
  const std::uint64_t frames_before = frames, depth_before = depth_images, missed_before = good.counts().missed;
  const Nanoseconds began = monotonic_now();
  most_mb = 0, most_descriptors = 0;
  {
    const ManySubscriptions many("ipc://" + (served.folder() / "gfp" / "state").string());
    const Flood flood({(served.folder() / "gfp" / "state").string(), (served.folder() / "gfp" / "sensor").string(), (served.folder() / "gfp" / "control").string()}, {soak_port(2), served.view_port()});
    listen_for(kFlood_s);
    const double lasted_s = std::chrono::duration<double>(monotonic_now() - began).count();
    trial.measured("connects_per_s", static_cast<double>(flood.connects()) / lasted_s);
    trial.measured("sensor_hz", static_cast<double>(frames - frames_before) / lasted_s);
    trial.measured("depth_images_hz", static_cast<double>(depth_images - depth_before) / lasted_s);
    trial.measured("missed", good.counts().missed - missed_before);
  }
  trial.measured("descriptors_before", descriptors_before);
  trial.measured("descriptors_max", most_descriptors);
  trial.measured("mb_before", before_mb);
  trial.measured("mb_max", most_mb);
  const double back_s = seconds_until([&] {
    listen_for(0.2);
    return process.rss_mb() <= before_mb + kMostExtraMb && process.descriptors() <= descriptors_before + 2;
  }, 30);
  trial.measured("mb_after", process.rss_mb());
  trial.measured("descriptors_after", process.descriptors());
  trial.measured("back_after_s", back_s);
  if (trial.figures["sensor_hz"] < kLeastRate_hz) trial.failure = "the sensor came down to " + std::to_string(trial.figures["sensor_hz"]) + " Hz";
  if (back_s < 0) trial.failure = std::to_string(process.rss_mb()) + " MB and " + std::to_string(process.descriptors()) + " descriptors half a minute after the flood, before it " + std::to_string(before_mb) + " and " + std::to_string(descriptors_before);
  return trial;
}

}  // namespace gfp::test
