#include "cli/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

namespace gfp {

ProgressBar::ProgressBar(std::ostream& out, std::string title) : out_(out), title_(std::move(title)), terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(std::size_t done, std::size_t total) {
  constexpr std::size_t kWidth = 40;
  const std::lock_guard lock(mutex_);
  most_ = std::max(most_, done);  // threads may report out of order
  const int percent = total > 0 ? static_cast<int>(100 * most_ / total) : 100;
  if (!terminal_ || percent == percent_) return;
  percent_ = percent;
  const std::size_t full = total > 0 ? kWidth * most_ / total : kWidth;
  out_ << '\r' << title_ << " [" << std::string(full, '#') << std::string(kWidth - full, '.') << "] " << most_ << '/' << total << (most_ == total ? "\n" : "") << std::flush;
}

}  // namespace gfp
