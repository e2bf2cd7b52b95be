#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

#include "cli/exit_code.hpp"
#include "gfp/client/subscriber.hpp"

namespace gfp {

/// Files of keys, for a daemon that serves tcp with CURVE; empty: none.
struct KeyFiles {
  std::string server, own;
};

void add_key_options(CLI::App& command, KeyFiles& files);

/// Reads the files that were named; says what is wrong with them, and returns false.
bool read_keys(const KeyFiles& files, CurveAccess& curve, ExitStatus& status);

/// What `gfp sub`, `gfp echo` and `gfp top` share: which topic, from where, how long.
struct ListenArguments {
  std::string topic;
  SubscriberOptions subscriber;
  double seconds = 0;       ///< 0: until interrupted.
  std::uint64_t count = 0;  ///< Messages; 0: any number.
  bool json = false;
  KeyFiles keys;
};

void add_stream_options(CLI::App& command, ListenArguments& arguments);  ///< All but the topic.
void add_listen_options(CLI::App& command, ListenArguments& arguments);

/// When to stop listening: SIGINT or SIGTERM (which end a command cleanly from now on), the time or the count.
class ListenEnd {
 public:
  explicit ListenEnd(const ListenArguments& arguments);
  bool reached(std::uint64_t messages) const;

 private:
  const ListenArguments& arguments_;
  Nanoseconds deadline_;
};

}  // namespace gfp
