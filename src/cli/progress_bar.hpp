#pragma once

#include <cstddef>
#include <mutex>
#include <ostream>
#include <string>

namespace gfp {

/// A bar on a terminal, redrawn when its percentage changes; ends its line when all is done. Safe from any thread.
/// Prints nothing where standard error is no terminal.
class ProgressBar {
 public:
  ProgressBar(std::ostream& out, std::string title);
  void show(std::size_t done, std::size_t total);

 private:
  std::ostream& out_;
  std::string title_;
  bool terminal_;
  std::mutex mutex_;
  std::size_t most_ = 0;
  int percent_ = -1;
};

}  // namespace gfp
