#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

#include "cli/exit_code.hpp"
#include "gfp/client/subscriber.hpp"

namespace gfp {

/// What `gfp sub`, `gfp echo` and `gfp top` share: which topic, from where, how long.
struct ListenArguments {
  std::string topic;
  SubscriberOptions subscriber;
  double seconds = 0;       ///< 0: until interrupted.
  std::uint64_t count = 0;  ///< Messages; 0: any number.
  bool json = false;
  std::string server_key, key;  ///< Key files, for a daemon that serves tcp with CURVE.
};

void add_stream_options(CLI::App& command, ListenArguments& arguments);  ///< All but the topic.
void add_listen_options(CLI::App& command, ListenArguments& arguments);

/// Reads the key files that were named into `arguments.subscriber`; says what is wrong with them, and returns false.
bool read_listen_keys(ListenArguments& arguments, ExitStatus& status);

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
