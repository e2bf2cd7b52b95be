// gfp echo TOPIC: the messages themselves, decoded. --json: every number, a line a message; else indented and cut short.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/listen.hpp"
#include "wire/message_json.hpp"

namespace gfp {
namespace {

Result<std::string> decoded(const Message& message, bool as_json) {
  if (!as_json) {
    const auto text = wire::payload_text(message.schema, message.payload);
    if (!text) return text;
    return message.topic + " seq " + std::to_string(message.seq) + " " + *text;
  }
  auto payload = wire::payload_json(message.schema, message.payload);
  if (!payload) return tl::unexpected(payload.error());
  const nlohmann::ordered_json line = {{"topic", message.topic}, {"schema", message.schema}, {"session", message.session}, {"seq", message.seq},
                                       {"stamp_ns", message.stamps.sensor.count()}, {"age_ms", 1e3 * message.age_s},
                                       {"dropped_since_last", message.dropped_since_last}, {"blob_bytes", message.blob.size()}, {"payload", std::move(*payload)}};
  return line.dump();
}

void echo(const ListenArguments& arguments, ExitStatus& status) {
  auto subscriber = Subscriber::connect({arguments.topic}, arguments.subscriber);
  if (!subscriber) return status.fail(std::cerr, arguments.topic, subscriber.error());
  const ListenEnd end(arguments);
  while (!end.reached(subscriber->counts().received)) {
    const auto message = subscriber->receive(std::chrono::milliseconds(200));
    if (!message) continue;
    const auto text = decoded(*message, arguments.json);
    if (text) std::cout << *text << std::endl;
    else status.fail(std::cerr, message->topic, text.error());
  }
  if (subscriber->counts().received == 0) status.fail(kExitUnavailable);
}

}  // namespace

void add_echo_command(CLI::App& app, ExitStatus& status) {
  auto arguments = std::make_shared<ListenArguments>();
  CLI::App* command = app.add_subcommand("echo", "Prints the messages of a topic, decoded");
  add_listen_options(*command, *arguments);
  command->callback([arguments, &status] {
    if (read_keys(arguments->keys, arguments->subscriber.curve, status)) echo(*arguments, status);
  });
}

}  // namespace gfp
