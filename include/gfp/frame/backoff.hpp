#pragma once

#include <stop_token>

namespace gfp {

struct BackoffOptions {
  double initial_s = 0.5;  ///< Pause before the first new attempt.
  double max_s = 30.0;     ///< The pause doubles with every attempt up to this.
};

template <class Visitor>
void visit_fields(BackoffOptions& o, Visitor&& field) {
  field("initial_s", o.initial_s, 0.001, 60.0);
  field("max_s", o.max_s, 0.001, 600.0);
}

/// Pauses between attempts: initial, twice that, ... up to the maximum. One thread at a time.
class Backoff {
 public:
  explicit Backoff(const BackoffOptions& options) : options_(options) { reset(); }

  void reset();    ///< It works again: the next pause is the initial one.
  double next_s(); ///< The pause that is due now, seconds; the one after is twice as long.

 private:
  BackoffOptions options_;
  double pause_s_ = 0;
};

/// Sleeps; false at once when stop is requested.
bool sleep_for(double seconds, const std::stop_token& stop);

}  // namespace gfp
