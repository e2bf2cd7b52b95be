#pragma once

#include <unistd.h>

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

/// A long count that can be done in parts: $GFP_SOAK_CYCLES cycles now (default 10), a line each in $GFP_SOAK_LEDGER (default: nowhere), which goes on
/// where it ended.
class Ledger {
 public:
  explicit Ledger(std::string name) : name_(std::move(name)) {
    if (const char* cycles = std::getenv("GFP_SOAK_CYCLES")) cycles_ = std::atoi(cycles);
    if (const char* file = std::getenv("GFP_SOAK_LEDGER")) file_ = file;
    std::ifstream before(file_);
    for (std::string line; std::getline(before, line);) done_ += line.starts_with("{\"run\": \"" + name_ + "\"") ? 1 : 0;
  }
  int cycles() const { return cycles_; }

  void add(double recovery_s, const Holdings& held) {
    ++done_;
    if (file_.empty()) return;
    std::ofstream(file_, std::ios::app) << "{\"run\": \"" << name_ << "\", \"cycle\": " << done_ << ", \"recovery_s\": " << recovery_s << ", \"rss_kb\": " << held.rss_kb << ", \"threads\": " << held.threads
                                        << ", \"descriptors\": " << held.descriptors << ", \"pid\": " << getpid() << "}\n";
  }

 private:
  std::string name_, file_;
  int cycles_ = 10, done_ = 0;
};

}  // namespace gfp::test
