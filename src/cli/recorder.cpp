// gfp recorder start|stop|trigger|status: the recorder of a running gfpd, whose files are on its host.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.hpp"
#include "cli/listen.hpp"
#include "gfp/client/control_client.hpp"

namespace gfp {
namespace {

struct RecorderArguments {
  std::string action;
  ControlOptions daemon;
  KeyFiles keys;
  bool json = false;
};

Result<RecorderState> ask(const RecorderArguments& arguments) {
  auto client = ControlClient::connect(arguments.daemon);
  if (!client) return tl::unexpected(client.error());
  if (arguments.action == "start") return client->recorder(RecorderAction::kStart);
  if (arguments.action == "stop") return client->recorder(RecorderAction::kStop);
  if (arguments.action == "trigger") return client->recorder(RecorderAction::kTrigger);
  return client->recorder(RecorderAction::kStatus);
}

void print(const RecorderState& state, bool json) {
  if (json) {
    std::cout << nlohmann::ordered_json{{"mode", state.mode}, {"state", state.state}, {"file", state.file}, {"files", state.files}, {"messages", state.messages},
                                        {"bytes", state.bytes}, {"lost_messages", state.lost_messages}, {"last_error", state.last_error}}.dump() << "\n";
    return;
  }
  std::cout << fmt::format("{} (configured: {}), {} files closed, {} messages, {:.1f} MB, {} lost\n", state.state, state.mode, state.files, state.messages, 1e-6 * static_cast<double>(state.bytes), state.lost_messages);
  if (!state.file.empty()) std::cout << state.file << "\n";
  if (!state.last_error.empty()) std::cout << state.last_error << "\n";
}

}  // namespace

void add_recorder_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("recorder", "Starts, stops and triggers the recorder of a running gfpd; its files are on gfpd's host, in recording.folder");
  const auto arguments = std::make_shared<RecorderArguments>();
  arguments->daemon.timeout = std::chrono::seconds(15);  // a slow disk is waited for
  command.add_option("ACTION", arguments->action, "start: everything from now on goes into a file; stop: it is closed; trigger: what the ring holds becomes a file; status")->required()->check(CLI::IsMember({"start", "stop", "trigger", "status"}));
  command.add_option("--endpoint", arguments->daemon.endpoint, "Of gfpd's control socket; by default this host's");
  add_key_options(command, arguments->keys);
  command.add_flag("--json", arguments->json, "One JSON object");
  command.callback([arguments, &status] {
    if (!read_keys(arguments->keys, arguments->daemon.curve, status)) return;
    const auto state = ask(*arguments);
    if (state) print(*state, arguments->json);
    else status.fail(std::cerr, "recorder", state.error());
  });
}

}  // namespace gfp
