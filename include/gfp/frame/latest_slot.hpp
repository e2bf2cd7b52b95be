#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <utility>

#include "gfp/core/mutex.hpp"

namespace gfp {

/// What a full hand-over does with the next value.
enum class HandOver {
  kLatestWins,  ///< Live data: the value that was not taken yet is replaced, and counted as dropped.
  kLossless,    ///< Deterministic replay: put() blocks until the value before has been taken.
};

/// A hand-over of capacity one between threads. Safe from any thread, for any number of producers and consumers.
template <class T>
class LatestSlot {
 public:
  explicit LatestSlot(HandOver policy = HandOver::kLatestWins) : policy_(policy) {}

  /// False: nothing was handed over, since the slot is closed or `stop` was requested while put() had to wait.
  bool put(T value, const std::stop_token& stop = {}) {
    MutexLock lock(mutex_);
    if (policy_ == HandOver::kLossless) {
      changed_.wait(lock, stop, [this]() GFP_REQUIRES(mutex_) { return closed_ || !value_; });
      if (value_) return false;
    }
    if (closed_) return false;
    if (value_) ++dropped_;
    value_ = std::move(value);
    changed_.notify_all();
    return true;
  }

  /// Blocks for the next value. Empty: the slot is closed and drained, or `stop` was requested.
  std::optional<T> take(const std::stop_token& stop = {}) {
    MutexLock lock(mutex_);
    changed_.wait(lock, stop, [this]() GFP_REQUIRES(mutex_) { return closed_ || value_; });
    if (stop.stop_requested()) return std::nullopt;
    return take_locked();
  }

  /// Does not block. Empty: there is nothing now.
  std::optional<T> try_take() {
    MutexLock lock(mutex_);
    return take_locked();
  }

  /// No value follows: put() refuses, take() hands out what is left and then says so. Idempotent.
  void close() {
    MutexLock lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  /// Closed and drained: take() will not return another value.
  bool finished() const {
    MutexLock lock(mutex_);
    return closed_ && !value_;
  }

  /// Values replaced before anybody took them.
  std::uint64_t dropped() const {
    MutexLock lock(mutex_);
    return dropped_;
  }

 private:
  std::optional<T> take_locked() GFP_REQUIRES(mutex_) {
    std::optional<T> taken = std::exchange(value_, std::nullopt);
    if (taken) changed_.notify_all();
    return taken;
  }

  const HandOver policy_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<T> value_ GFP_GUARDED_BY(mutex_);
  std::uint64_t dropped_ GFP_GUARDED_BY(mutex_) = 0;
  bool closed_ GFP_GUARDED_BY(mutex_) = false;
};

}  // namespace gfp
