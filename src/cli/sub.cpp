// gfp sub TOPIC: what a running gfpd publishes. Scenes as a table that is refreshed, other topics as a line a message.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/listen.hpp"
#include "cli/scene_table.hpp"
#include "gfp/client/scene_subscriber.hpp"
#include "wire/scene_json.hpp"

namespace gfp {
namespace {

constexpr std::chrono::milliseconds kPatience{200};  ///< Between looks at whether to end.
constexpr Nanoseconds kRefresh{200'000'000};         ///< Of the table: more often cannot be read.

void print_counts(const SubscriberCounts& counts) {
  std::cerr << fmt::format("{} messages, {} missed, {} stale, {} corrupt\n", counts.received, counts.missed, counts.stale, counts.corrupt);
}

void show(const Scene& scene) {
  const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  if (is_terminal) std::cout << "\x1b[H\x1b[2J";
  std::cout << scene_table(scene) << (is_terminal ? "" : "\n") << std::flush;
}

void sub_scenes(const ListenArguments& arguments, ExitStatus& status) {
  auto subscriber = SceneSubscriber::connect(arguments.subscriber);
  if (!subscriber) return status.fail(std::cerr, arguments.topic, subscriber.error());
  const ListenEnd end(arguments);
  std::uint64_t scenes = 0;
  Nanoseconds shown{};
  while (!end.reached(scenes)) {
    const auto scene = subscriber->next(kPatience);
    if (!scene && scene.error().code != ErrorCode::kTimeout) std::cerr << "gfp: " << scene.error().what << "\n";
    if (!scene) continue;
    ++scenes;
    if (arguments.json) std::cout << scene_json(*scene, {arguments.topic, "", {}}).dump() << std::endl;
    else if (const Nanoseconds now = monotonic_now(); now - shown >= kRefresh) {
      show(*scene);
      shown = now;
    }
  }
  print_counts(subscriber->counts());
  if (scenes == 0) status.fail(kExitUnavailable);
}

void sub_messages(const ListenArguments& arguments, ExitStatus& status) {
  auto subscriber = Subscriber::connect({arguments.topic}, arguments.subscriber);
  if (!subscriber) return status.fail(std::cerr, arguments.topic, subscriber.error());
  const ListenEnd end(arguments);
  while (!end.reached(subscriber->counts().received)) {
    const auto message = subscriber->receive(kPatience);
    if (!message) continue;
    const std::size_t bytes = message->payload.size() + message->blob.size();
    if (arguments.json) {
      const nlohmann::ordered_json line = {{"topic", message->topic}, {"schema", message->schema}, {"session", message->session}, {"seq", message->seq},
                                           {"stamp_ns", message->stamps.sensor.count()}, {"age_ms", 1e3 * message->age_s}, {"bytes", bytes}};
      std::cout << line.dump() << std::endl;
    } else {
      std::cout << fmt::format("{:<36} {:<20} seq {:<8} {:>9} bytes {:>8.2f} ms old", message->topic, message->schema, message->seq, bytes, 1e3 * message->age_s) << std::endl;
    }
  }
  print_counts(subscriber->counts());
  if (subscriber->counts().received == 0) status.fail(kExitUnavailable);
}

}  // namespace

void add_sub_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<ListenArguments>();
  CLI::App* command = app.add_subcommand("sub", "Shows what a running gfpd publishes: scenes as a table, other topics a line a message");
  add_listen_options(*command, *arguments);
  command->callback([arguments, &status] {
    if (!read_keys(arguments->keys, arguments->subscriber.curve, status)) return;
    if (arguments->topic == "/gfp/scene/") sub_scenes(*arguments, status);
    else sub_messages(*arguments, status);
  });
}

}  // namespace gfp
