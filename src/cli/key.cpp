// gfp key new|show: keys for CURVE, which lets a daemon serve tcp encrypted and to those it knows only.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "gfp/client/curve_key.hpp"

namespace gfp {
namespace {

struct KeyArguments {
  std::string file;
  bool json = false;
};

void print(const KeyArguments& arguments, const CurveKey& key, const std::string& text) {
  if (arguments.json) std::cout << nlohmann::ordered_json{{"file", arguments.file}, {"public", key.public_key}, {"has_secret", !key.secret_key.empty()}}.dump() << "\n";
  else std::cout << text << "\n";
}

void make(const KeyArguments& arguments, ExitStatus& status) {
  const CurveKey key = new_curve_key();
  if (const auto written = write_curve_key(arguments.file, key); !written) {
    status.fail(std::cerr, arguments.file, written.error());
    return;
  }
  print(arguments, key, arguments.file + ".key (keep it to yourself) and " + arguments.file + ".pub: " + key.public_key);
}

void show(const KeyArguments& arguments, ExitStatus& status) {
  const auto key = read_curve_key(arguments.file);
  if (key) print(arguments, *key, key->public_key);
  else status.fail(std::cerr, arguments.file, key.error());
}

}  // namespace

void add_key_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("key", "Keys for encrypted and authenticated tcp (CURVE)");
  command.require_subcommand(1);
  const auto arguments = std::make_shared<KeyArguments>();
  CLI::App& make_command = *command.add_subcommand("new", "Makes NAME.key and NAME.pub; put the .pub into the daemon's publish.authorized_keys");
  CLI::App& show_command = *command.add_subcommand("show", "Prints the public half of a key file");
  for (CLI::App* one : {&make_command, &show_command}) {
    one->add_option("NAME", arguments->file, one == &make_command ? "Path without extension" : "A .key or .pub file")->required();
    one->add_flag("--json", arguments->json, "One JSON object");
  }
  make_command.callback([arguments, &status] { make(*arguments, status); });
  show_command.callback([arguments, &status] { show(*arguments, status); });
}

}  // namespace gfp
