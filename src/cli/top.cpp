// gfp top: how a running gfpd does: rates, latencies, drops, traffic. Refreshed with every status it sends.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/listen.hpp"
#include "wire/message_json.hpp"
#include "wire/topics.hpp"

namespace gfp {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
T value(const Json& status, const char* key, T otherwise) { return status.contains(key) ? status[key].get<T>() : otherwise; }

/// 64-bit numbers travel as text in Protobuf's JSON.
std::uint64_t count(const Json& status, const char* key) {
  if (!status.contains(key)) return 0;
  return status[key].is_string() ? std::stoull(status[key].get<std::string>()) : status[key].get<std::uint64_t>();
}

std::string daemon_line(const Json& status) {
  return fmt::format("gfpd {}  {}  up {:.0f} s  {} scenes  {} object(s)  {} messages  {:.1f} MB  {} dropped  {} subscription(s)  {} refused\n", value<std::string>(status, "version", "?"),
                     value<std::string>(status, "state", "?"), value(status, "uptime_s", 0.0), count(status, "scenes"), count(status, "objects"), count(status, "messages"),
                     1e-6 * static_cast<double>(count(status, "bytes")), count(status, "dropped"), count(status, "subscriptions"), count(status, "refused"));
}

std::string sensor_line(const std::string& name, const Json& status) {
  return fmt::format("{:<14} {:<10} {:>6.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9} {:>8} {:>8} {:>8} {:>10}  {}\n", name, value<std::string>(status, "state", "?"), value(status, "fps", 0.0),
                     value(status, "scenes_fps", 0.0), value(status, "latency_p50_ms", 0.0), value(status, "latency_p99_ms", 0.0), count(status, "frames"), count(status, "frames_dropped"),
                     count(status, "timeouts"), count(status, "corrupt_frames"), count(status, "reconnects"), value<std::string>(status, "last_error", ""));
}

std::string table(const std::map<std::string, Json>& statuses) {
  std::string text = statuses.contains("gfpd") ? daemon_line(statuses.at("gfpd")) : "gfpd: no status yet\n";
  text += fmt::format("{:<14} {:<10} {:>6} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>10}\n", "sensor", "state", "fps", "scenes/s", "p50 ms", "p99 ms", "frames", "dropped", "timeouts", "corrupt",
                      "reconnects");
  for (const auto& [name, status] : statuses)
    if (name != "gfpd") text += sensor_line(name, status);
  return text;
}

void top(const ListenArguments& arguments, ExitStatus& status) {
  auto subscriber = Subscriber::connect({arguments.topic}, arguments.subscriber);
  if (!subscriber) return status.fail(std::cerr, arguments.topic, subscriber.error());
  const ListenEnd end(arguments);
  const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  std::map<std::string, Json> statuses;
  while (!end.reached(subscriber->counts().received)) {
    const auto message = subscriber->receive(std::chrono::milliseconds(200));
    constexpr double kSilence_s = 3;
    if (!message && is_terminal && subscriber->silent_for_s() > kSilence_s)
      std::cout << fmt::format("\rnothing heard for {:.0f} s ", subscriber->silent_for_s()) << std::flush;
    if (!message) continue;
    auto payload = wire::payload_json(message->schema, message->payload);
    if (!payload) continue;
    const std::string name = message->topic.substr(arguments.topic.size(), message->topic.size() - arguments.topic.size() - 1);
    if (arguments.json) std::cout << Json{{"name", name}, {"status", *payload}}.dump() << std::endl;
    statuses[name] = std::move(*payload);
    if (!arguments.json && (is_terminal || name == "gfpd")) std::cout << (is_terminal ? "\x1b[H\x1b[2J" : "") << table(statuses) << std::flush;
  }
  if (subscriber->counts().received == 0) status.fail(kExitUnavailable);
}

}  // namespace

void add_top_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<ListenArguments>();
  arguments->topic = wire::kStatusPrefix;
  CLI::App* command = app.add_subcommand("top", "Shows how a running gfpd does: rates, latencies, drops, traffic");
  add_stream_options(*command, *arguments);
  command->callback([arguments, &status] {
    if (read_keys(arguments->keys, arguments->subscriber.curve, status)) top(*arguments, status);
  });
}

}  // namespace gfp
