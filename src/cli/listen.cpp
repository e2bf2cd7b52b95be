#include "cli/listen.hpp"

#include <iostream>
#include <utility>

#include "cli/interrupt.hpp"

namespace gfp {

void add_listen_options(CLI::App& command, ListenArguments& arguments) {
  command.add_option("TOPIC", arguments.topic, "Topic or prefix of topics, as in /gfp/scene/")->required();
  add_stream_options(command, arguments);
}

void add_stream_options(CLI::App& command, ListenArguments& arguments) {
  command.add_option("--endpoint", arguments.subscriber.endpoints, "ZeroMQ endpoint, as in ipc:///run/gfp/state; default: this host's gfpd");
  command.add_option("--seconds", arguments.seconds, "Ends after so many seconds")->check(CLI::NonNegativeNumber);
  command.add_option("--count", arguments.count, "Ends after so many messages");
  command.add_flag("--json", arguments.json, "A JSON object a line");
  add_key_options(command, arguments.keys);
}

void add_key_options(CLI::App& command, KeyFiles& files) {
  CLI::Option* server = command.add_option("--server-key", files.server, "The daemon's .pub file, where it serves tcp with CURVE");
  CLI::Option* own = command.add_option("--key", files.own, "One's own .key file (gfp key new)");
  server->needs(own);
  own->needs(server);
}

bool read_keys(const KeyFiles& files, CurveAccess& curve, ExitStatus& status) {
  for (const auto& [file, is_own] : {std::pair{&files.server, false}, {&files.own, true}}) {
    if (file->empty()) continue;
    auto key = read_curve_key(*file);
    if (key && is_own && key->secret_key.empty()) key = failure(ErrorCode::kInvalidArgument, "only a public key, expected one's own .key file");
    if (!key) return status.fail(std::cerr, *file, key.error()), false;
    if (is_own) curve.key = std::move(*key);
    else curve.server_public_key = std::move(key->public_key);
  }
  return true;
}

ListenEnd::ListenEnd(const ListenArguments& arguments) : arguments_(arguments), deadline_(monotonic_now() + Nanoseconds(static_cast<std::int64_t>(1e9 * arguments.seconds))) {
  catch_interrupts();
}

bool ListenEnd::reached(std::uint64_t messages) const {
  if (interrupted()) return true;
  if (arguments_.count > 0 && messages >= arguments_.count) return true;
  return arguments_.seconds > 0 && monotonic_now() >= deadline_;
}

}  // namespace gfp
