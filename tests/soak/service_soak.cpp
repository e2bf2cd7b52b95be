// What the service promises its clients, in great numbers, on the real gfpd and its real sockets.
#include <CLI/CLI.hpp>

#include "soak/service_trials.hpp"

int main(int argc, char** argv) {
  using namespace gfp::test;
  std::string ledger;
  std::vector<std::string> listen, listen_plainly;
  std::uint64_t stuck = 0, floods = 0, joins = 0, keys = 0, terminations = 0;
  double stuck_s = 30;
  CLI::App app{"Stuck, many, late and unwelcome clients of gfpd, and its end", "gfp_service_soak"};
  app.add_option("LEDGER", ledger, "Where results go, and where a run goes on");
  app.add_option("--stuck", stuck, "20 stopped subscribers and 4 viewers that never read: so many trials, over ipc and tcp in turn");
  app.add_option("--stuck-seconds", stuck_s, "For so long a trial")->capture_default_str();
  app.add_option("--floods", floods, "A minute of 1000 connects a second: so many");
  app.add_option("--joins", joins, "Subscribers that come while objects change");
  app.add_option("--keys", keys, "Clients without the right key");
  app.add_option("--terminations", terminations, "SIGTERM while it records and publishes");
  app.add_option("--listen", listen, "For itself: be a subscriber of these endpoints")->group("");
  app.add_option("--listen-plainly", listen_plainly)->group("");
  CLI11_PARSE(app, argc, argv);
  if (!listen.empty()) return listen_for_ever(listen, false), 0;
  if (!listen_plainly.empty()) return listen_for_ever(listen_plainly, true), 0;
  const SoakLedger soak(ledger);
  const bool sound = soak.run("join", joins, join_trial, 100) && soak.run("key", keys, key_trial) && soak.run("termination", terminations, termination_trial, 5) &&
                     soak.run("flood", floods, flood_trial, 1) && soak.run("stuck", stuck, [&](std::uint64_t number) { return stuck_trial(number, stuck_s); }, 1);
  return sound ? 0 : 1;
}
