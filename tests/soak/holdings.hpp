#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace gfp::test {

/// What this process holds of the machine.
struct Holdings {
  long rss_kb = 0, threads = 0, descriptors = 0;

  static Holdings now() {
    Holdings held;
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmRSS:")) held.rss_kb = std::strtol(line.c_str() + 6, nullptr, 10);
      if (line.starts_with("Threads:")) held.threads = std::strtol(line.c_str() + 8, nullptr, 10);
    }
    held.descriptors = std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
    return held;
  }
};

}  // namespace gfp::test
