#include "cli/listen.hpp"

#include <csignal>

namespace gfp {
namespace {

volatile std::sig_atomic_t interrupted = 0;

}  // namespace

void add_listen_options(CLI::App& command, ListenArguments& arguments) {
  command.add_option("TOPIC", arguments.topic, "Topic or prefix of topics, as in /gfp/scene/")->required();
  command.add_option("--endpoint", arguments.subscriber.endpoints, "ZeroMQ endpoint, as in ipc:///run/gfp/state; default: this host's gfpd");
  command.add_option("--seconds", arguments.seconds, "Ends after so many seconds")->check(CLI::NonNegativeNumber);
  command.add_option("--count", arguments.count, "Ends after so many messages");
  command.add_flag("--json", arguments.json, "A JSON object a line");
}

ListenEnd::ListenEnd(const ListenArguments& arguments) : arguments_(arguments), deadline_(monotonic_now() + Nanoseconds(static_cast<std::int64_t>(1e9 * arguments.seconds))) {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

bool ListenEnd::reached(std::uint64_t messages) const {
  if (interrupted != 0) return true;
  if (arguments_.count > 0 && messages >= arguments_.count) return true;
  return arguments_.seconds > 0 && monotonic_now() >= deadline_;
}

}  // namespace gfp
