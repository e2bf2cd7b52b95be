#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace gfp {

/// One thing that `gfp doctor` looked at.
struct Finding {
  enum class Level { kOk, kWarning, kProblem };
  std::string check;   ///< A word or two: `udev rules`, `receive buffer`...
  Level level = Level::kOk;
  std::string what;    ///< Quantity, value and bound.
  std::string fix;     ///< A line to run or to add; empty where all is well.
};

std::string_view to_string(Finding::Level level);

/// What is known of the machine and its user besides its files.
struct MachineUser {
  bool is_root = false;
  std::set<std::string> groups;       ///< By name.
  bool clock_synchronised = true;     ///< As the kernel says it (adjtimex).
};
MachineUser current_user();

/// Looks at what sensors need: udev rules, groups, a kernel driver in the way, USB memory, FireWire, receive buffers, network links, clock, container, processor.
/// Reads files below `root` only and changes nothing. In a fixed order.
std::vector<Finding> examine_machine(const std::filesystem::path& root, const MachineUser& user);

}  // namespace gfp
