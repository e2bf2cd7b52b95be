#include <sstream>
#include <zmq.hpp>

#include "gfp/client/control_client.hpp"
#include "gfp/v1/status.pb.h"
#include "soak/daemon_process.hpp"
#include "soak/service_trials.hpp"

namespace gfp::test {
namespace {

using namespace std::chrono_literals;

/// True once so many seconds have passed.
auto after(double seconds) {
  return [end = monotonic_now() + Nanoseconds(static_cast<std::int64_t>(1e9 * seconds))] { return monotonic_now() > end; };
}

/// A gfpd behind a key, with one authorized client.
struct GuardedDaemon {
  TemporaryFolder keys;
  const CurveKey server = new_curve_key(), alice = new_curve_key(), mallory = new_curve_key(), revoked = new_curve_key();
  std::unique_ptr<DaemonProcess> daemon;

  GuardedDaemon() {
    static_cast<void>(write_curve_key(keys / "server", server));
    std::filesystem::create_directories(keys / "authorized");
    authorize("alice", alice);
    authorize("revoked", revoked);
    std::vector<std::string> settings = {"publish.curve_key=" + (keys / "server.key").string(), "publish.authorized_keys=" + (keys / "authorized").string()};
    const char* const names[3] = {"sensor", "state", "control"};
    for (int i = 0; i < 3; ++i) settings.push_back("publish." + std::string(names[i]) + "_endpoints=[\"ipc://{folder}/" + names[i] + "\",\"" + tcp(i) + "\"]");
    daemon = std::make_unique<DaemonProcess>(settings);
    if (!daemon->is_serving()) daemon.reset();
    // It is let in once, and then no more.
    if (!hears(1, {server.public_key, revoked}, after(20))) daemon.reset();
    std::filesystem::remove(keys / "authorized" / "revoked.pub");
    std::this_thread::sleep_for(3s);
  }
  void authorize(const std::string& name, const CurveKey& key) const { keys.write("authorized/" + name + ".pub", "public: " + key.public_key + "\n"); }
  static std::string tcp(int i) { return "tcp://127.0.0.1:" + std::to_string(soak_port(4 + i)); }

  /// Whether a client of one of the sockets (sensor, state, control) is served before `done` says that it has waited long enough.
  template <class Done>
  static bool hears(int socket, const CurveAccess& access, Done&& done) {
    SubscriberOptions options;
    options.endpoints = {tcp(socket)};
    options.curve = access;
    auto control = ControlClient::connect({tcp(2), 100ms, access});
    auto subscriber = Subscriber::connect({"/gfp/"}, options);
    while (!done())
      if (socket == 2 ? control->snapshot().has_value() : subscriber->receive(100ms).has_value()) return true;
    return false;
  }
  std::uint64_t refused() const {
    const auto snapshot = ControlClient::connect({daemon->endpoint("control"), 20s, {}})->snapshot("/gfp/status/gfpd/");
    v1::DaemonStatus status;
    return snapshot && !snapshot->topics.empty() && status.ParseFromString(snapshot->topics[0].payload) ? status.refused() : 0;
  }
  /// The shortest time between two lines of the log about the refusal of one peer; all of them here are 127.0.0.1.
  double shortest_gap_s() const {
    double last = -100, shortest = 100;
    std::istringstream log(daemon->log());
    for (std::string line; std::getline(log, line);) {
      if (line.find("refused") == std::string::npos || line.find("127.0.0.1") == std::string::npos) continue;
      const double now = 3600 * std::stod(line.substr(11, 2)) + 60 * std::stod(line.substr(14, 2)) + std::stod(line.substr(17, 6));
      shortest = std::min(shortest, now < last ? 100 : now - last);
      last = now;
    }
    return shortest;
  }
};

}  // namespace

Trial key_trial(std::uint64_t number) {
  static GuardedDaemon guarded;
  Trial trial;
  if (!guarded.daemon) return {"the daemon does not serve who is authorized", {}};
  const std::pair<const char*, CurveAccess> kinds[] = {{"a key that is not authorized", {guarded.server.public_key, guarded.mallory}},
                                                       {"a key that was revoked", {guarded.server.public_key, guarded.revoked}},
                                                       {"no key (NULL)", {}},
                                                       {"another server's key", {guarded.mallory.public_key, guarded.alice}},
                                                       {"a stolen public half", {guarded.server.public_key, {guarded.alice.public_key, guarded.mallory.secret_key}}}};
  const auto& [what, access] = kinds[number % 5];
  const int socket = static_cast<int>(number / 5 % 3);
  const std::uint64_t before = guarded.refused();
  const auto too_long = after(10);
  if (GuardedDaemon::hears(socket, access, [&] { return guarded.refused() > before || too_long(); })) return {std::string(what) + " was served", {}};
  if (guarded.refused() == before) trial.failure = std::string(what) + " was not counted as refused";
  if (!GuardedDaemon::hears(socket, {guarded.server.public_key, guarded.alice}, after(20))) trial.failure = std::string("after ") + what + " who is authorized is not served";
  const double gap_s = guarded.shortest_gap_s();
  trial.measured("log_lines_per_s_max", 1 / gap_s);
  if (gap_s < 0.9) trial.failure = "two lines of the log about one peer within " + std::to_string(gap_s) + " s";
  if (number % 5 == 4 && seconds_until([&] { return guarded.daemon->log().find("refused") != std::string::npos; }, 10) < 0) trial.failure = "nothing of it is in the log";
  return trial;
}

}  // namespace gfp::test
