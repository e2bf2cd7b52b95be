#pragma once

#include <chrono>
#include <map>
#include <string>
#include <utility>

#include "gfp/core/time.hpp"

namespace gfp {

/// How long each stage took, in milliseconds of wall time; a stage that runs several times adds up. Stages know nothing of
/// it, and no result depends on it. One thread at a time: every parallel task has its own.
class StageTimings {
 public:
  template <class Stage>
  decltype(auto) measure(const char* name, Stage&& stage) {
    const Stopwatch stopwatch{ms_[name], monotonic_now()};
    return std::forward<Stage>(stage)();
  }
  const std::map<std::string, double>& ms() const { return ms_; }

 private:
  struct Stopwatch {
    double& total_ms;
    Nanoseconds start;
    ~Stopwatch() { total_ms += std::chrono::duration<double, std::milli>(monotonic_now() - start).count(); }
  };
  std::map<std::string, double> ms_;
};

}  // namespace gfp
