#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

#include "cli/exit_code.hpp"
#include "gfp/client/subscriber.hpp"

namespace gfp {

/// What `gfp sub` and `gfp echo` share: which topic, from where, how long.
struct ListenArguments {
  std::string topic;
  SubscriberOptions subscriber;
  double seconds = 0;       ///< 0: until interrupted.
  std::uint64_t count = 0;  ///< Messages; 0: any number.
  bool json = false;
};

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
