#include <csignal>

#include "gfp/core/random.hpp"
#include "gfp/recording/mcap_reader.hpp"
#include "gfp/v1/status.pb.h"
#include "soak/daemon_process.hpp"
#include "soak/service_trials.hpp"

namespace gfp::test {

using namespace std::chrono_literals;

Trial termination_trial(std::uint64_t number) {
  constexpr double kWithin_s = 2;
  Trial trial;
  DaemonProcess daemon({"recording.mode=continuous", "recording.folder={folder}/recordings", "recording.min_free_mb=0"});
  Subscriber everything = daemon.subscribe({"/gfp/"});
  // Under load: frames, scenes, one who reads all and one who never reads.
  const Subscriber lazy = daemon.subscribe({"/gfp/"});
  if (!daemon.is_serving()) return {"nothing is published: " + daemon.log(), {}};
  Random random(number + 1);
  const Nanoseconds end = monotonic_now() + Nanoseconds(random.below(3'000'000)) * 1000;
  while (monotonic_now() < end) static_cast<void>(everything.receive(10ms));

  daemon.process().signal(SIGTERM);
  const Nanoseconds told = monotonic_now();
  const pid_t pid = daemon.process().pid();
  siginfo_t info{};
  bool goodbye = false;
  double ended_s = -1;
  while (ended_s < 0 || !goodbye) {
    const auto message = everything.receive(ended_s < 0 ? 10ms : 1000ms);
    const double now_s = std::chrono::duration<double>(monotonic_now() - told).count();
    if (ended_s < 0 && waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid) ended_s = now_s;
    if (now_s > 20) break;
    v1::DaemonStatus status;
    if (message && message->topic == "/gfp/status/gfpd/" && status.ParseFromString(message->payload)) goodbye = goodbye || status.state() == "stopping";
    if (!message && ended_s >= 0) break;  // it is gone, and so is what it had sent
  }
  trial.measured("ended_after_s", ended_s);
  if (ended_s < 0) return {"SIGTERM did not end it within 20 s: " + daemon.log(), trial.figures};
  const int status = daemon.process().wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) trial.failure = "it ended with status " + std::to_string(status) + ": " + daemon.log();
  if (ended_s > kWithin_s) trial.failure = "it took " + std::to_string(ended_s) + " s to end";
  if (!goodbye) trial.failure = "its last status did not come";
  if (everything.counts().corrupt > 0) trial.failure = std::to_string(everything.counts().corrupt) + " messages were not whole";
  int files = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(daemon.folder() / "gfp" / "recordings", error)) {
    ++files;
    const auto reader = McapReader::open(entry.path());
    if (entry.path().extension() != ".mcap" || !reader || !reader->has_index()) trial.failure = entry.path().string() + " was not finished";
  }
  if (files == 0) trial.failure = "no recording";
  return trial;
}

}  // namespace gfp::test
